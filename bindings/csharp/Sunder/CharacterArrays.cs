using System;

namespace Sunder
{
  /// <summary>A rigged model of arrays of one's own, for Character.FromArrays(). Space is right-handed, in metres.</summary>
  public sealed class CharacterArrays
  {
    public string Name;
    /// <summary>Parents come before their children.</summary>
    public BoneArrays[] Bones;
    public SkinArrays[] Skins;
    public MeshArrays[] Meshes;
    /// <summary>May be null.</summary>
    public ClipArrays[] Clips;
    /// <summary>Of the targets of all meshes, one mesh after the other; null: zeros.</summary>
    public float[] RestMorphWeights;
  }

  public sealed class BoneArrays
  {
    /// <summary>Unique, not empty.</summary>
    public string Name;
    /// <summary>-1: none.</summary>
    public int Parent = -1;
    public BoneTransform Rest;
  }

  public sealed class SkinArrays
  {
    public string Name;
    /// <summary>Per slot: a bone.</summary>
    public uint[] Bones;
    /// <summary>Per slot: 12 numbers, column after column, the inverse of the bone's bind transform.</summary>
    public float[] BoneFromBind;
  }

  public sealed class MeshArrays
  {
    public string Name;
    public int Skin;
    /// <summary>3 per vertex.</summary>
    public float[] Positions;
    /// <summary>3 per vertex, or null.</summary>
    public float[] Normals;
    /// <summary>4 per vertex, or null.</summary>
    public float[] Tangents;
    /// <summary>Each 2 per vertex; or null.</summary>
    public float[][] UvSets;
    /// <summary>Each 4 per vertex, linear; or null.</summary>
    public float[][] ColorSets;
    public AttributeArrays[] Attributes;
    public MorphTargetArrays[] MorphTargets;
    /// <summary>One more than vertices: offsets into Influences.</summary>
    public uint[] FirstInfluence;
    public Influence[] Influences;
    /// <summary>3 per triangle, counter-clockwise.</summary>
    public uint[] Triangles;
    /// <summary>Per triangle; null: all are of submesh 0.</summary>
    public uint[] TriangleSubmesh;
    /// <summary>Null: one.</summary>
    public SubmeshArrays[] Submeshes;
  }

  public sealed class SubmeshArrays
  {
    public string Name;
    public uint? Material;
  }

  public sealed class AttributeArrays
  {
    public string Name;
    /// <summary>Components per vertex, 1 to 4.</summary>
    public float[] Values;
    public int Components;
    /// <summary>Copied from a vertex, not interpolated.</summary>
    public bool IsLabel;
  }

  /// <summary>3 numbers per vertex each; or null.</summary>
  public sealed class MorphTargetArrays
  {
    public string Name;
    public float[] PositionDeltas, NormalDeltas, TangentDeltas;
  }

  public sealed class ClipArrays
  {
    public string Name;
    /// <summary>Seconds: the time of the last key.</summary>
    public float Duration;
    public ChannelArrays[] Channels;
  }

  /// <summary>Keys of one animated value, as in glTF 2.0.</summary>
  public sealed class ChannelArrays
  {
    public ChannelTarget Target;
    /// <summary>The bone, or the first morph weight.</summary>
    public int Index;
    /// <summary>3; 4 for rotations; or the number of morph weights.</summary>
    public int Width = 3;
    public Interpolation Interpolation;
    public float[] Times;
    /// <summary>Per key: Width numbers; cubic: three times as many.</summary>
    public float[] Values;
  }
}
