using System;

namespace Sunder.Tests
{
  /// <summary>Laws of ragdolls: their joints hang together, and poses and places of bodies follow from one another.</summary>
  static class Ragdolls
  {
    static Vector3d Transform(double[] frames, int body, Matrix3x4d joint)
    {
      double[] at = { 0, 0, 0 };
      for (int row = 0; row < 3; ++row)
      {
        at[row] = frames[12 * body + 9 + row];
        for (int column = 0; column < 3; ++column) at[row] += frames[12 * body + 3 * column + row] * joint[column, 3];
      }
      return new Vector3d(at[0], at[1], at[2]);
    }

    internal static void Check(Character character)
    {
      double[] pose = new double[12 * character.BoneCount], back = new double[pose.Length];
      character.ComputeMatrices(null, pose);
      using (Ragdoll ragdoll = new Ragdoll(character, pose))
      {
        int count = ragdoll.Bodies.Length;
        Expect.That(count > 0 && count <= 16, "bodies");
        double[] places = new double[12 * count], turns = new double[4 * count];
        ragdoll.Place(pose, places);
        for (int i = 0; i < count; ++i)
        {
          RagdollBody body = ragdoll.Bodies[i];
          Expect.That(body.Mass > 0 && body.Moments.X > 0, "mass and moments");
          if (body.Parent == Constants.None) continue;
          Expect.That(body.Parent < i, "parents come first");
          Vector3d above = Transform(places, (int)body.Parent, body.ParentFromJoint), here = Transform(places, i, body.BodyFromJoint);
          Expect.Near(above.X, here.X, 1e-6, "joint");
          Expect.Near(above.Y, here.Y, 1e-6, "joint");
          Expect.Near(above.Z, here.Z, 1e-6, "joint");
        }
        ragdoll.GetPose(places, back);
        for (int i = 0; i < pose.Length; ++i) Expect.Near(back[i], pose[i], 1e-5, "pose");
        ragdoll.GetTurns(places, turns);
        for (int i = 0; i < count; ++i)
          Expect.Near(turns[4 * i] * turns[4 * i] + turns[4 * i + 1] * turns[4 * i + 1] + turns[4 * i + 2] * turns[4 * i + 2] +
            turns[4 * i + 3] * turns[4 * i + 3], 1, 1e-9, "turn");
        Expect.Throws<ArgumentException>(() => ragdoll.Place(pose, new double[3]), "modelFromBody");
        ragdoll.Dispose();
        Expect.Throws<ObjectDisposedException>(() => ragdoll.Place(pose, places), "Ragdoll");
      }
      Expect.Throws<ArgumentException>(() => new Ragdoll(character, new double[1]), "modelFromBone");
    }

    internal static void Limits(Character tube)
    {
      double[] pose = new double[12 * tube.BoneCount];
      tube.ComputeMatrices(null, pose);
      uint bone;
      using (Ragdoll ragdoll = new Ragdoll(tube, pose)) bone = ragdoll.Bodies[1].Bone;
      BoneLimit hinge = new BoneLimit { Bone = bone, Kind = JointKind.Hinge, Axis = new Vector3d(0, 0, 1), Lower = -0.1, Upper = 0.2 };
      using (Ragdoll ragdoll = new Ragdoll(tube, pose, limits: new[] { hinge }))
        Expect.That(ragdoll.Bodies[1].Limit.Kind == JointKind.Hinge && ragdoll.Bodies[1].Limit.Upper == 0.2, "the given limit");
      RagdollOptions none = RagdollOptions.Default;
      none.MaximumBodies = 0;
      Expect.Throws<SunderException>(() => new Ragdoll(tube, pose, options: none), "bodies");
    }
  }
}
