namespace Sunder
{
  /// <summary>One mesh of an instance as it is drawn, and what changed in it since an epoch. Its arrays are views, valid until the
  /// next update or change of the scene.</summary>
  public readonly unsafe struct PosedMesh
  {
    readonly Native.PosedMesh raw;
    readonly Moment moment;

    internal PosedMesh(Native.PosedMesh raw, Moment moment)
    {
      this.raw = raw;
      this.moment = moment;
    }

    public int VertexCount { get { return (int)raw.VertexCount; } }
    /// <summary>The size that the index buffer needs, in triangles.</summary>
    public int TriangleCapacity { get { return (int)raw.TriangleCapacity; } }
    /// <summary>To be passed as `seen` next time.</summary>
    public ulong Epoch { get { return raw.Epoch; } }
    /// <summary>3 per vertex, model space; none before an update.</summary>
    public FloatView Positions { get { return new FloatView(raw.Positions, 3ul * raw.VertexCount, moment); } }
    /// <summary>3 per vertex, or none.</summary>
    public FloatView Normals { get { return new FloatView(raw.Normals, 3ul * raw.VertexCount, moment); } }
    /// <summary>4 per vertex, or none.</summary>
    public FloatView Tangents { get { return new FloatView(raw.Tangents, 4ul * raw.VertexCount, moment); } }
    /// <summary>One draw call each.</summary>
    public DrawRangeView DrawRanges { get { return new DrawRangeView(raw.Ranges, raw.RangeCount, moment); } }
    /// <summary>To be uploaded.</summary>
    public VertexRangeView DirtyVertices { get { return new VertexRangeView(raw.DirtyVertices, raw.DirtyVertexCount, moment); } }
    /// <summary>Vertices whose other attributes are new: Instance.GetMesh() has them.</summary>
    public VertexRangeView DirtyAttributes { get { return new VertexRangeView(raw.DirtyAttributes, raw.DirtyAttributeCount, moment); } }
    /// <summary>In order.</summary>
    public TriangleWriteView TriangleWrites { get { return new TriangleWriteView(raw.TriangleWrites, raw.TriangleWriteCount, moment); } }
    /// <summary>3 per triangle. Not empty: the index buffer starts anew with these.</summary>
    public UIntView InitialTriangles { get { return new UIntView(raw.InitialTriangles, 3ul * raw.InitialTriangleCount, moment); } }
  }
}
