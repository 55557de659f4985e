using System;
using System.Collections.Generic;
using System.Runtime.InteropServices;
using UnityEngine.Rendering;
using Unity.Collections;

namespace Unity.Collections
{
  public struct NativeArray<T> where T : struct
  {
    readonly T[] array;
    public NativeArray(T[] from) { array = from; }
    public int Length { get { return array.Length; } }
    public T this[int i] { get { return array[i]; } }
  }
}

namespace UnityEngine.Rendering
{
  public enum VertexAttribute { Position, Normal, Tangent, Color, TexCoord0, TexCoord1, TexCoord2, TexCoord3, TexCoord4, TexCoord5, TexCoord6, TexCoord7, BlendWeight, BlendIndices }
  public enum VertexAttributeFormat { Float32, Float16, UNorm8, SNorm8, UNorm16, SNorm16, UInt8, SInt8, UInt16, SInt16, UInt32, SInt32 }
  public enum IndexFormat { UInt16, UInt32 }
  [Flags] public enum MeshUpdateFlags { Default = 0, DontValidateIndices = 1, DontResetBoneBounds = 2, DontNotifyMeshUsers = 4, DontRecalculateBounds = 8 }

  public struct VertexAttributeDescriptor
  {
    public VertexAttribute attribute { get; set; }
    public VertexAttributeFormat format { get; set; }
    public int dimension { get; set; }
    public int stream { get; set; }
    public VertexAttributeDescriptor(VertexAttribute attribute, VertexAttributeFormat format, int dimension, int stream = 0) : this()
    {
      this.attribute = attribute;
      this.format = format;
      this.dimension = dimension;
      this.stream = stream;
    }
  }

  public struct SubMeshDescriptor
  {
    public Bounds bounds { get; set; }
    public MeshTopology topology { get; set; }
    public int indexStart { get; set; }
    public int indexCount { get; set; }
    public int baseVertex { get; set; }
    public int firstVertex { get; set; }
    public int vertexCount { get; set; }
    public SubMeshDescriptor(int indexStart, int indexCount, MeshTopology topology = MeshTopology.Triangles) : this()
    {
      this.indexStart = indexStart;
      this.indexCount = indexCount;
      this.topology = topology;
    }
  }
}

namespace UnityEngine
{
  public enum MeshTopology { Triangles = 0, Quads = 2, Lines = 3 }

  public struct BoneWeight1
  {
    public float weight { get; set; }
    public int boneIndex { get; set; }
  }

  /// <summary>Buffers as a graphics card has them: streams of bytes by a layout, and indices. The arrays of the simple interface are made
  /// from them, or written into them.</summary>
  public sealed class Mesh : Object
  {
    sealed class Shape
    {
      internal string Name;
      internal readonly List<float> Weights = new List<float>();
      internal readonly List<Vector3[][]> Frames = new List<Vector3[][]>();
    }

    VertexAttributeDescriptor[] layout = new VertexAttributeDescriptor[0];
    readonly byte[][] streams = new byte[4][];
    uint[] indices = new uint[0];
    SubMeshDescriptor[] submeshes = new SubMeshDescriptor[1];
    Matrix4x4[] poses = new Matrix4x4[0];
    readonly List<Shape> shapes = new List<Shape>();
    public byte[] BonesPerVertex = new byte[0];
    public BoneWeight1[] BoneWeights = new BoneWeight1[0];
    /// <summary>How many bytes were uploaded.</summary>
    public long Uploaded;

    public int vertexCount { get; private set; }
    public bool isReadable { get { return IsReadable; } }
    public bool IsReadable = true;
    public Bounds bounds { get; set; }
    public IndexFormat indexFormat { get; set; }
    /// <summary>Of bind poses that were made.</summary>
    public int Copies;
    public Matrix4x4[] bindposes { get { ++Copies; return (Matrix4x4[])poses.Clone(); } set { poses = (Matrix4x4[])value.Clone(); } }
    public int subMeshCount { get { return submeshes.Length; } set { Array.Resize(ref submeshes, value); } }

    public void MarkDynamic() { }
    public bool HasVertexAttribute(VertexAttribute attribute) { return Find(attribute) >= 0; }

    // ---- the interface of buffers ----

    public void SetVertexBufferParams(int vertexCount, params VertexAttributeDescriptor[] attributes)
    {
      if (shapes.Count > 0) throw new InvalidOperationException("blend shapes are of another number of vertices");
      this.vertexCount = vertexCount;
      layout = attributes;
      for (int stream = 0; stream < 4; ++stream) streams[stream] = new byte[vertexCount * Stride(stream)];
      for (int i = 1; i < layout.Length; ++i)
        if (layout[i].stream > layout[i - 1].stream + 1) throw new ArgumentException("streams have a gap");
    }

    /// <summary>Uploads throw.</summary>
    public bool IsBroken;

    public void SetVertexBufferData<T>(T[] data, int dataStart, int meshBufferStart, int count, int stream = 0, MeshUpdateFlags flags = MeshUpdateFlags.Default) where T : struct
    {
      if (IsBroken) throw new ArgumentException("a mesh that is broken");
      Uploaded += Copy(data, dataStart, streams[stream], meshBufferStart, count);
    }

    public void SetIndexBufferParams(int indexCount, IndexFormat format)
    {
      if (format != IndexFormat.UInt32) throw new NotSupportedException();
      indices = new uint[indexCount];
    }

    public void SetIndexBufferData<T>(T[] data, int dataStart, int meshBufferStart, int count, MeshUpdateFlags flags = MeshUpdateFlags.Default) where T : struct
    {
      Uploaded += Copy(data, dataStart, indices, meshBufferStart, count);
    }

    static unsafe long Copy<T>(T[] from, int first, Array to, int at, int count) where T : struct
    {
      long size = Marshal.SizeOf(typeof(T));
      if (first < 0 || count < 0 || first + count > from.Length || size * (at + count) > Buffer.ByteLength(to)) throw new ArgumentOutOfRangeException();
      GCHandle source = GCHandle.Alloc(from, GCHandleType.Pinned), target = GCHandle.Alloc(to, GCHandleType.Pinned);
      Buffer.MemoryCopy((byte*)source.AddrOfPinnedObject() + size * first, (byte*)target.AddrOfPinnedObject() + size * at, size * count, size * count);
      source.Free();
      target.Free();
      return size * count;
    }

    public void SetSubMesh(int index, SubMeshDescriptor desc, MeshUpdateFlags flags = MeshUpdateFlags.Default)
    {
      if (desc.indexStart + desc.indexCount > indices.Length) throw new ArgumentException("a submesh beyond the index buffer");
      submeshes[index] = desc;
    }
    public SubMeshDescriptor GetSubMesh(int index) { return submeshes[index]; }

    int Stride(int stream)
    {
      int stride = 0;
      foreach (VertexAttributeDescriptor one in layout)
        if (one.stream == stream) stride += 4 * one.dimension;
      return stride;
    }

    int Find(VertexAttribute attribute)
    {
      for (int i = 0; i < layout.Length; ++i)
        if (layout[i].attribute == attribute) return i;
      return -1;
    }

    /// <summary>What a shader reads.</summary>
    public float Read(VertexAttribute attribute, int vertex, int component) { return BitConverter.ToSingle(streams[layout[Find(attribute)].stream], Offset(attribute, vertex, component)); }
    public uint ReadUInt(VertexAttribute attribute, int vertex, int component) { return BitConverter.ToUInt32(streams[layout[Find(attribute)].stream], Offset(attribute, vertex, component)); }
    public int IndexCount { get { return indices.Length; } }
    public uint ReadIndex(int place) { return indices[place]; }
    public Vector3 ReadVector(VertexAttribute attribute, int vertex) { return new Vector3(Read(attribute, vertex, 0), Read(attribute, vertex, 1), Read(attribute, vertex, 2)); }

    int Offset(VertexAttribute attribute, int vertex, int component)
    {
      int index = Find(attribute), stream = layout[index].stream, offset = 0;
      for (int i = 0; i < index; ++i)
        if (layout[i].stream == stream) offset += 4 * layout[i].dimension;
      return vertex * Stride(stream) + offset + 4 * component;
    }

    // ---- the simple interface ----

    readonly Dictionary<VertexAttribute, float[]> simple = new Dictionary<VertexAttribute, float[]>();

    /// <summary>All attributes are of one stream then.</summary>
    void Set(VertexAttribute attribute, int dimension, float[] values)
    {
      if (attribute == VertexAttribute.Position) vertexCount = values.Length / 3;
      if (values.Length != dimension * vertexCount) throw new ArgumentException("an array of another number of vertices");
      simple[attribute] = values;
      List<VertexAttributeDescriptor> made = new List<VertexAttributeDescriptor>();
      foreach (VertexAttribute one in Enum.GetValues(typeof(VertexAttribute)))
        if (simple.ContainsKey(one)) made.Add(new VertexAttributeDescriptor(one, VertexAttributeFormat.Float32, simple[one].Length / vertexCount));
      layout = made.ToArray();
      streams[0] = new byte[vertexCount * Stride(0)];
      foreach (VertexAttributeDescriptor one in layout)
        for (int v = 0; v < vertexCount; ++v)
          Buffer.BlockCopy(simple[one.attribute], 4 * one.dimension * v, streams[0], Offset(one.attribute, v, 0), 4 * one.dimension);
    }

    float[] Get(VertexAttribute attribute)
    {
      int index = Find(attribute);
      if (index < 0) return new float[0];
      int dimension = layout[index].dimension;
      float[] values = new float[dimension * vertexCount];
      for (int i = 0; i < values.Length; ++i) values[i] = Read(attribute, i / dimension, i % dimension);
      return values;
    }

    Vector3[] GetVectors(VertexAttribute attribute)
    {
      float[] from = Get(attribute);
      Vector3[] to = new Vector3[from.Length / 3];
      for (int i = 0; i < to.Length; ++i) to[i] = new Vector3(from[3 * i], from[3 * i + 1], from[3 * i + 2]);
      return to;
    }

    void SetVectors(VertexAttribute attribute, Vector3[] values)
    {
      float[] to = new float[3 * values.Length];
      for (int i = 0; i < values.Length; ++i)
      {
        to[3 * i] = values[i].x;
        to[3 * i + 1] = values[i].y;
        to[3 * i + 2] = values[i].z;
      }
      Set(attribute, 3, to);
    }

    public Vector3[] vertices { get { return GetVectors(VertexAttribute.Position); } set { SetVectors(VertexAttribute.Position, value); } }
    public Vector3[] normals { get { return GetVectors(VertexAttribute.Normal); } set { SetVectors(VertexAttribute.Normal, value); } }

    public Vector4[] tangents
    {
      get
      {
        float[] from = Get(VertexAttribute.Tangent);
        Vector4[] to = new Vector4[from.Length / 4];
        for (int i = 0; i < to.Length; ++i) to[i] = new Vector4(from[4 * i], from[4 * i + 1], from[4 * i + 2], from[4 * i + 3]);
        return to;
      }
      set
      {
        float[] to = new float[4 * value.Length];
        for (int i = 0; i < to.Length; ++i) to[i] = i % 4 == 0 ? value[i / 4].x : i % 4 == 1 ? value[i / 4].y : i % 4 == 2 ? value[i / 4].z : value[i / 4].w;
        Set(VertexAttribute.Tangent, 4, to);
      }
    }

    public Color[] colors
    {
      get
      {
        float[] from = Get(VertexAttribute.Color);
        Color[] to = new Color[from.Length / 4];
        for (int i = 0; i < to.Length; ++i) to[i] = new Color(from[4 * i], from[4 * i + 1], from[4 * i + 2], from[4 * i + 3]);
        return to;
      }
      set
      {
        float[] to = new float[4 * value.Length];
        for (int i = 0; i < to.Length; ++i) to[i] = i % 4 == 0 ? value[i / 4].r : i % 4 == 1 ? value[i / 4].g : i % 4 == 2 ? value[i / 4].b : value[i / 4].a;
        Set(VertexAttribute.Color, 4, to);
      }
    }

    public void GetUVs(int channel, List<Vector2> uvs)
    {
      uvs.Clear();
      float[] from = Get(VertexAttribute.TexCoord0 + channel);
      for (int i = 0; i < from.Length; i += 2) uvs.Add(new Vector2(from[i], from[i + 1]));
    }

    public void SetUVs(int channel, List<Vector2> uvs)
    {
      float[] to = new float[2 * uvs.Count];
      for (int i = 0; i < to.Length; ++i) to[i] = i % 2 == 0 ? uvs[i / 2].x : uvs[i / 2].y;
      Set(VertexAttribute.TexCoord0 + channel, 2, to);
    }

    public NativeArray<byte> GetBonesPerVertex() { return new NativeArray<byte>(BonesPerVertex); }
    public NativeArray<BoneWeight1> GetAllBoneWeights() { return new NativeArray<BoneWeight1>(BoneWeights); }
    public MeshTopology GetTopology(int submesh) { return submeshes[submesh].topology; }

    public int[] GetTriangles(int submesh)
    {
      int[] to = new int[submeshes[submesh].indexCount];
      for (int i = 0; i < to.Length; ++i) to[i] = (int)indices[submeshes[submesh].indexStart + i];
      return to;
    }

    public void SetTriangles(int[] triangles, int submesh)
    {
      int first = indices.Length;
      Array.Resize(ref indices, first + triangles.Length);
      for (int i = 0; i < triangles.Length; ++i) indices[first + i] = (uint)triangles[i];
      submeshes[submesh] = new SubMeshDescriptor(first, triangles.Length);
    }

    public void RecalculateBounds()
    {
      Vector3[] all = vertices;
      Bounds made = new Bounds(all[0], Vector3.zero);
      foreach (Vector3 one in all) made.Encapsulate(one);
      bounds = made;
    }

    // ---- blend shapes ----

    public int blendShapeCount { get { return shapes.Count; } }
    public string GetBlendShapeName(int shape) { return shapes[shape].Name; }
    public int GetBlendShapeFrameCount(int shape) { return shapes[shape].Frames.Count; }
    public float GetBlendShapeFrameWeight(int shape, int frame) { return shapes[shape].Weights[frame]; }
    public void ClearBlendShapes() { shapes.Clear(); }

    public void GetBlendShapeFrameVertices(int shape, int frame, Vector3[] positions, Vector3[] normals, Vector3[] tangents)
    {
      Vector3[][] from = shapes[shape].Frames[frame], to = { positions, normals, tangents };
      for (int i = 0; i < 3; ++i)
      {
        if (from[i] == null) Array.Clear(to[i], 0, to[i].Length);
        else Array.Copy(from[i], to[i], vertexCount);
      }
    }

    public void AddBlendShapeFrame(string shapeName, float frameWeight, Vector3[] positions, Vector3[] normals, Vector3[] tangents)
    {
      if (positions.Length != vertexCount) throw new ArgumentException("a blend shape of another number of vertices");
      Shape shape = shapes.Find(one => one.Name == shapeName);
      if (shape == null) shapes.Add(shape = new Shape { Name = shapeName });
      shape.Weights.Add(frameWeight);
      shape.Frames.Add(new[] { positions, normals, tangents });
    }
  }
}
