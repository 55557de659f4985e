using System;
using Sunder.Native;

namespace Sunder
{
  /// <summary>A character as rigid bodies and joints of a physics engine; docs/ragdoll.md of the project.</summary>
  public sealed unsafe class Ragdoll : IDisposable
  {
    readonly RagdollHandle handle;
    readonly int boneCount;

    /// <summary>Parents before children. Parent is Constants.None for a body without a joint.</summary>
    public readonly RagdollBody[] Bodies;

    /// <summary>modelFromBone: the pose in which the character stands, 12 numbers per bone, column after column. morphWeights: null:
    /// those of rest. limits: of joints, at most one per bone; null: what the clips show. Their place in `options` is not read.</summary>
    public Ragdoll(Character character, double[] modelFromBone, float[] morphWeights = null, RagdollOptions? options = null, BoneLimit[] limits = null)
    {
      boneCount = character.BoneCount;
      Library.CheckLength(modelFromBone, 12L * boneCount, "modelFromBone");
      if (morphWeights != null) Library.CheckLength(morphWeights, character.MorphWeightCount, "morphWeights");
      RagdollOptions chosen = options ?? RagdollOptions.Default;
      uint number, count;
      RagdollBody* bodies;
      fixed (double* pose = modelFromBone)
      fixed (float* weights = morphWeights)
      fixed (BoneLimit* given = limits)
      {
        chosen.Limits = given;
        chosen.LimitCount = limits == null ? 0 : (uint)limits.Length;
        SunderException.Check(NativeCalls.sunder_create_ragdoll(character.Number, pose, (uint)boneCount, weights, &chosen, &number));
      }
      GC.KeepAlive(character);
      handle = new RagdollHandle(number);
      SunderException.Check(NativeCalls.sunder_get_ragdoll_bodies(number, &bodies, &count));
      Bodies = new RagdollBody[count];
      for (int i = 0; i < Bodies.Length; ++i) Bodies[i] = bodies[i];
      GC.KeepAlive(handle);
    }

    /// <summary>Where a pose puts the bodies: 12 numbers per body, written. Of two poses they give the velocities with which the bodies
    /// start.</summary>
    public void Place(double[] modelFromBone, double[] modelFromBody)
    {
      Library.CheckLength(modelFromBone, 12L * boneCount, "modelFromBone");
      Library.CheckLength(modelFromBody, 12L * Bodies.Length, "modelFromBody");
      fixed (double* from = modelFromBone)
      fixed (double* to = modelFromBody)
        SunderException.Check(NativeCalls.sunder_place_bodies(handle.Number, from, (uint)boneCount, to));
      GC.KeepAlive(this);
    }

    /// <summary>How bodies in these places turn their joints: quaternions x y z w, 4 numbers per body, written. Of the places of a pose of
    /// a clip: targets of motors.</summary>
    public void GetTurns(double[] modelFromBody, double[] turns)
    {
      Library.CheckLength(modelFromBody, 12L * Bodies.Length, "modelFromBody");
      Library.CheckLength(turns, 4L * Bodies.Length, "turns");
      fixed (double* from = modelFromBody)
      fixed (double* to = turns)
        SunderException.Check(NativeCalls.sunder_get_joint_turns(handle.Number, from, (uint)Bodies.Length, to));
      GC.KeepAlive(this);
    }

    /// <summary>The pose in which bodies in these places hold the bones: 12 numbers per bone, written, for Instance.SetMatrices().</summary>
    public void GetPose(double[] modelFromBody, double[] modelFromBone)
    {
      Library.CheckLength(modelFromBody, 12L * Bodies.Length, "modelFromBody");
      Library.CheckLength(modelFromBone, 12L * boneCount, "modelFromBone");
      fixed (double* from = modelFromBody)
      fixed (double* to = modelFromBone)
        SunderException.Check(NativeCalls.sunder_pose_of_bodies(handle.Number, from, (uint)Bodies.Length, to));
      GC.KeepAlive(this);
    }

    public void Dispose() { handle.Dispose(); }
  }
}
