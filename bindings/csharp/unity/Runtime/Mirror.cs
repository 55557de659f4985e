using UnityEngine;

namespace Sunder.Unity
{
  /// <summary>Unity's space is left-handed, the library's right-handed: x is mirrored, as importers of glTF do it, and triangles turn
  /// the other way. Texture coordinates have their origin at the top there. So logs and files are those of the model that other
  /// programs see.</summary>
  public static class Mirror
  {
    public static Vector3d ToSunder(Vector3 v) { return new Vector3d(-v.x, v.y, v.z); }
    public static Vector3 ToUnity(Vector3d v) { return new Vector3((float)-v.X, (float)v.Y, (float)v.Z); }

    /// <summary>A rotation: mirrored, it turns the other way about the axes y and z.</summary>
    public static Vector4d ToSunder(Quaternion q) { return new Vector4d(q.x, -q.y, -q.z, q.w); }
    public static Quaternion ToUnity(Vector4d q) { return new Quaternion((float)q.X, (float)-q.Y, (float)-q.Z, (float)q.W); }

    /// <summary>12 numbers from `at` on, column after column: the matrix between two mirrors.</summary>
    public static void Write(Matrix4x4 m, double[] to, int at)
    {
      to[at] = m.m00;
      to[at + 1] = -m.m10;
      to[at + 2] = -m.m20;
      to[at + 3] = -m.m01;
      to[at + 4] = m.m11;
      to[at + 5] = m.m21;
      to[at + 6] = -m.m02;
      to[at + 7] = m.m12;
      to[at + 8] = m.m22;
      to[at + 9] = -m.m03;
      to[at + 10] = m.m13;
      to[at + 11] = m.m23;
    }

    public static Matrix4x4 ToUnity(Matrix3x4d m)
    {
      Matrix4x4 to = Matrix4x4.identity;
      for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 4; ++column)
          to[row, column] = (float)((row == 0) == (column == 0) ? m[row, column] : -m[row, column]);
      return to;
    }

    /// <summary>Translation, rotation and scale of a transform between two bones.</summary>
    public static BoneTransform ToTransform(Matrix4x4 m)
    {
      Quaternion rotation = m.rotation;
      Vector3 scale = m.lossyScale;
      BoneTransform to = new BoneTransform();
      to.Translation = new Vector3f(-m.m03, m.m13, m.m23);
      to.Rotation = new Vector4f(rotation.x, -rotation.y, -rotation.z, rotation.w);
      to.Scale = new Vector3f(scale.x, scale.y, scale.z);
      return to;
    }
  }
}
