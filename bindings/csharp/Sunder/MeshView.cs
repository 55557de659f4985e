using System;

namespace Sunder
{
  /// <summary>A triangle mesh in bind space with one skin. Its arrays are views on the library's memory.</summary>
  public readonly unsafe struct MeshView
  {
    readonly Native.Mesh raw;
    readonly Moment arrays;
    readonly Moment tables;

    /// <summary>tables: of the pointers to arrays in the struct, which may have a shorter life.</summary>
    internal MeshView(Native.Mesh raw, Epoch arrays, Epoch tables)
    {
      this.raw = raw;
      this.arrays = arrays.Now;
      this.tables = tables.Now;
    }

    public string Name { get { tables.Check(); return Text(raw.Name); } }
    public int VertexCount { get { return (int)raw.VertexCount; } }
    public int TriangleCount { get { return (int)raw.TriangleCount; } }
    public int SubmeshCount { get { return (int)raw.SubmeshCount; } }
    public int UvSetCount { get { return (int)raw.UvSetCount; } }
    public int ColorSetCount { get { return (int)raw.ColorSetCount; } }
    public int AttributeCount { get { return (int)raw.AttributeCount; } }
    public int MorphTargetCount { get { return (int)raw.MorphTargetCount; } }
    /// <summary>Of target 0, in the weights of a pose.</summary>
    public int FirstMorphWeight { get { return (int)raw.FirstMorphWeight; } }
    public int Skin { get { return (int)raw.Skin; } }

    /// <summary>3 per vertex.</summary>
    public FloatView Positions { get { return Floats(raw.Positions, 3); } }
    /// <summary>3 per vertex, or none.</summary>
    public FloatView Normals { get { return Floats(raw.Normals, 3); } }
    /// <summary>4 per vertex, or none; the last is the sign of the bitangent.</summary>
    public FloatView Tangents { get { return Floats(raw.Tangents, 4); } }
    /// <summary>2 per vertex.</summary>
    public FloatView UvSet(int set) { CheckIndex(set, raw.UvSetCount); return Floats(raw.UvSets[set], 2); }
    /// <summary>4 per vertex, linear.</summary>
    public FloatView ColorSet(int set) { CheckIndex(set, raw.ColorSetCount); return Floats(raw.ColorSets[set], 4); }
    public string AttributeName(int attribute) { CheckIndex(attribute, raw.AttributeCount); return Text(raw.Attributes[attribute].Name); }
    /// <summary>AttributeWidth() per vertex.</summary>
    public FloatView AttributeValues(int attribute) { return Floats(raw.Attributes[Checked(attribute, raw.AttributeCount)].Values, AttributeWidth(attribute)); }
    public int AttributeWidth(int attribute)
    {
      int width = (int)raw.Attributes[Checked(attribute, raw.AttributeCount)].Components;
      tables.KeepAlive();
      return width;
    }

    public string MorphTargetName(int target) { return Text(raw.MorphTargets[Checked(target, raw.MorphTargetCount)].Name); }
    /// <summary>3 per vertex, or none.</summary>
    public FloatView PositionDeltas(int target) { return Floats(raw.MorphTargets[Checked(target, raw.MorphTargetCount)].PositionDeltas, 3); }
    public FloatView NormalDeltas(int target) { return Floats(raw.MorphTargets[Checked(target, raw.MorphTargetCount)].NormalDeltas, 3); }
    public FloatView TangentDeltas(int target) { return Floats(raw.MorphTargets[Checked(target, raw.MorphTargetCount)].TangentDeltas, 3); }

    /// <summary>VertexCount + 1 offsets into Influences.</summary>
    public UIntView FirstInfluence { get { tables.Check(); return new UIntView(raw.FirstInfluence, raw.VertexCount + 1ul, arrays); } }
    public InfluenceView Influences
    {
      get
      {
        tables.Check();
        uint count = raw.VertexCount == 0 ? 0 : raw.FirstInfluence[raw.VertexCount];
        tables.KeepAlive();
        return new InfluenceView(raw.Influences, count, arrays);
      }
    }

    /// <summary>3 per triangle, counter-clockwise; one vertex three times: removed.</summary>
    public UIntView Triangles { get { tables.Check(); return new UIntView(raw.Triangles, 3ul * raw.TriangleCount, arrays); } }
    public UIntView TriangleSubmesh { get { tables.Check(); return new UIntView(raw.TriangleSubmesh, raw.TriangleCount, arrays); } }
    public string SubmeshName(int submesh) { return Text(raw.Submeshes[Checked(submesh, raw.SubmeshCount)].Name); }
    /// <summary>Index in the source file; null: none.</summary>
    public uint? SubmeshMaterial(int submesh)
    {
      uint material = raw.Submeshes[Checked(submesh, raw.SubmeshCount)].Material;
      tables.KeepAlive();
      return material == Constants.None ? (uint?)null : material;
    }

    /// <summary>What is handed in was read from the tables, so they are kept until here.</summary>
    FloatView Floats(float* first, int width)
    {
      tables.Check();
      tables.KeepAlive();
      return new FloatView(first, (ulong)width * raw.VertexCount, arrays);
    }

    string Text(byte* text)
    {
      string read = Utf8.Read(text);
      tables.KeepAlive();
      return read;
    }

    void CheckIndex(int index, uint count)
    {
      tables.Check();
      if ((uint)index >= count) throw Epoch.OutOfRange(index, (int)count);
    }

    int Checked(int index, uint count) { CheckIndex(index, count); return index; }
  }
}
