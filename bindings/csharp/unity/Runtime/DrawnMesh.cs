using System;
using System.Collections.Generic;
using System.Runtime.InteropServices;
using UnityEngine;
using UnityEngine.Rendering;

namespace Sunder.Unity
{
  /// <summary>A mesh of Unity that follows an instance: what changed is copied, mirrored and uploaded. Buffers have room for later
  /// tears; vertices that are not used yet stand where vertex 0 stands.
  ///
  /// Stream 0 has positions, normals and tangents; stream 1 colours and texture coordinates; stream 2 weights, if Unity skins.</summary>
  sealed unsafe class DrawnMesh
  {
    [StructLayout(LayoutKind.Sequential)]
    internal struct SkinRow
    {
      internal float Weight0, Weight1, Weight2, Weight3;
      internal uint Bone0, Bone1, Bone2, Bone3;
    }

    // Bounds are set by hand, and indices are the library's.
    const MeshUpdateFlags Flags = MeshUpdateFlags.DontRecalculateBounds | MeshUpdateFlags.DontValidateIndices | MeshUpdateFlags.DontResetBoneBounds;
    const int RunGap = 256;

    internal readonly UnityEngine.Mesh Mesh;
    /// <summary>One per draw call.</summary>
    internal int[] SubmeshOfRange = new int[0];

    readonly SkinSource source;
    readonly bool isSkinned;
    readonly int posedWidth, attributeWidth;
    float[] posed = new float[0], attributes = new float[0];
    SkinRow[] rows = new SkinRow[0];
    uint[] indices = new uint[0];
    DrawRange[] ranges = new DrawRange[0];
    int capacity, vertexCount;
    ulong seen;
    Vector3 low, high;

    /// <summary>like: the mesh whose bind poses and blend shapes it has, if Unity skins.</summary>
    internal DrawnMesh(SkinSource source, bool isSkinned, UnityEngine.Mesh like)
    {
      this.source = source;
      this.isSkinned = isSkinned;
      posedWidth = 3 + (source.HasNormals ? 3 : 0) + (source.HasTangents ? 4 : 0);
      attributeWidth = (source.HasColors ? 4 : 0) + 2 * source.UvCount;
      Mesh = new UnityEngine.Mesh { name = like.name + " (torn)" };
      Mesh.MarkDynamic();
      if (!isSkinned) return;
      Mesh.bounds = like.bounds;
    }

    /// <summary>Copies what changed since the last call, and uploads it. Returns whether draw calls are others than before.</summary>
    internal bool Follow(Instance instance, UnityEngine.Mesh like)
    {
      PosedMesh drawn = instance.GetPosedMesh(0, seen);
      bool hasNew = seen == 0 || drawn.DirtyAttributes.Count > 0;
      // A mesh that the library does not pose has no vertices there.
      if (!isSkinned) vertexCount = drawn.VertexCount;
      else if (hasNew) vertexCount = instance.GetMesh().VertexCount;
      bool grows = vertexCount > capacity;
      if (grows) Grow();
      if (!isSkinned) CopyPosed(drawn, grows);
      if ((hasNew || grows) && (isSkinned || attributeWidth > 0)) CopyAttributes(instance.GetMesh(), drawn.DirtyAttributes, grows);
      bool hasNewBuffers = CopyTriangles(drawn) || grows;
      bool hasNewRanges = SetRanges(drawn.DrawRanges, hasNewBuffers);
      if ((hasNew || grows) && isSkinned) FollowShapes(instance.GetMesh(), like);
      seen = drawn.Epoch;
      return hasNewRanges;
    }

    // ---- vertices ----

    void Grow()
    {
      capacity = seen == 0 ? vertexCount + vertexCount / 4 + 64 : vertexCount + vertexCount / 2 + 64;
      Array.Resize(ref posed, posedWidth * capacity);
      Array.Resize(ref attributes, attributeWidth * capacity);
      if (isSkinned) Array.Resize(ref rows, capacity);
      List<VertexAttributeDescriptor> layout = new List<VertexAttributeDescriptor>();
      layout.Add(new VertexAttributeDescriptor(VertexAttribute.Position, VertexAttributeFormat.Float32, 3, 0));
      if (source.HasNormals) layout.Add(new VertexAttributeDescriptor(VertexAttribute.Normal, VertexAttributeFormat.Float32, 3, 0));
      if (source.HasTangents) layout.Add(new VertexAttributeDescriptor(VertexAttribute.Tangent, VertexAttributeFormat.Float32, 4, 0));
      if (source.HasColors) layout.Add(new VertexAttributeDescriptor(VertexAttribute.Color, VertexAttributeFormat.Float32, 4, 1));
      for (int i = 0; i < source.UvCount; ++i)
        layout.Add(new VertexAttributeDescriptor(VertexAttribute.TexCoord0 + i, VertexAttributeFormat.Float32, 2, 1));
      // Streams have no gaps: without colours and texture coordinates the weights are in the second.
      if (isSkinned)
      {
        layout.Add(new VertexAttributeDescriptor(VertexAttribute.BlendWeight, VertexAttributeFormat.Float32, 4, SkinStream));
        layout.Add(new VertexAttributeDescriptor(VertexAttribute.BlendIndices, VertexAttributeFormat.UInt32, 4, SkinStream));
      }
      // Vertex shapes of another length would not fit; FollowShapes() adds them again.
      Mesh.ClearBlendShapes();
      Mesh.SetVertexBufferParams(capacity, layout.ToArray());
    }

    int SkinStream { get { return attributeWidth > 0 ? 2 : 1; } }

    void CopyPosed(PosedMesh from, bool all)
    {
      VertexRangeView dirty = from.DirtyVertices;
      FloatView positions = from.Positions;
      if (positions.Count == 0) return;
      float* place = positions.Pointer;
      float* normal = from.Normals.Count > 0 ? from.Normals.Pointer : null;
      float* tangent = from.Tangents.Count > 0 ? from.Tangents.Pointer : null;
      uint count = 0;
      for (int i = 0; i < dirty.Count; ++i) count += dirty[i].Count;
      if (all || count >= vertexCount) BeginBounds(place);
      if (all)
      {
        CopyRows(place, normal, tangent, 0, vertexCount);
        RepeatFirst(posed, posedWidth);
        Mesh.SetVertexBufferData(posed, 0, 0, posedWidth * capacity, 0, Flags);
      }
      else
      {
        for (int i = 0; i < dirty.Count; ++i)
        {
          int first = (int)dirty[i].First, n = (int)dirty[i].Count;
          CopyRows(place, normal, tangent, first, n);
          Mesh.SetVertexBufferData(posed, posedWidth * first, posedWidth * first, posedWidth * n, 0, Flags);
        }
      }
      if (dirty.Count > 0 || all) Mesh.bounds = new Bounds(0.5f * (low + high), high - low);
    }

    void BeginBounds(float* place) { low = high = new Vector3(-place[0], place[1], place[2]); }

    /// <summary>A range of vertices into stream 0; the bounds grow by them.</summary>
    void CopyRows(float* place, float* normal, float* tangent, int first, int count)
    {
      float lowX = low.x, lowY = low.y, lowZ = low.z, highX = high.x, highY = high.y, highZ = high.z;
      int width = posedWidth;
      fixed (float* rowsOfPosed = posed)
      {
        float* to = rowsOfPosed + width * first;
        for (int v = first; v < first + count; ++v, to += width)
        {
          float x = -place[3 * v], y = place[3 * v + 1], z = place[3 * v + 2];
          to[0] = x;
          to[1] = y;
          to[2] = z;
          if (x < lowX) lowX = x;
          if (x > highX) highX = x;
          if (y < lowY) lowY = y;
          if (y > highY) highY = y;
          if (z < lowZ) lowZ = z;
          if (z > highZ) highZ = z;
          if (normal == null) continue;
          to[3] = -normal[3 * v];
          to[4] = normal[3 * v + 1];
          to[5] = normal[3 * v + 2];
          if (tangent == null) continue;
          to[6] = -tangent[4 * v];
          to[7] = tangent[4 * v + 1];
          to[8] = tangent[4 * v + 2];
          to[9] = -tangent[4 * v + 3];
        }
      }
      low = new Vector3(lowX, lowY, lowZ);
      high = new Vector3(highX, highY, highZ);
    }

    void RepeatFirst(float[] array, int width)
    {
      for (int i = width * vertexCount; i < width * capacity; ++i) array[i] = array[i % width];
    }

    void CopyAttributes(MeshView bind, VertexRangeView dirty, bool all)
    {
      if (all)
      {
        CopyAttributes(bind, 0, vertexCount);
        RepeatFirst(attributes, attributeWidth);
        if (isSkinned)
        {
          RepeatFirst(posed, posedWidth);
          for (int v = vertexCount; v < capacity; ++v) rows[v] = rows[0];
        }
        Upload(0, capacity);
        return;
      }
      for (int i = 0; i < dirty.Count; ++i)
      {
        CopyAttributes(bind, (int)dirty[i].First, (int)dirty[i].Count);
        Upload((int)dirty[i].First, (int)dirty[i].Count);
      }
    }

    void Upload(int first, int count)
    {
      if (attributeWidth > 0) Mesh.SetVertexBufferData(attributes, attributeWidth * first, attributeWidth * first, attributeWidth * count, 1, Flags);
      if (!isSkinned) return;
      Mesh.SetVertexBufferData(posed, posedWidth * first, posedWidth * first, posedWidth * count, 0, Flags);
      Mesh.SetVertexBufferData(rows, first, first, count, SkinStream, Flags);
    }

    void CopyAttributes(MeshView bind, int first, int count)
    {
      int at = 0;
      if (source.HasColors)
      {
        float* colors = bind.ColorSet(0).Pointer;
        for (int v = first; v < first + count; ++v)
          for (int i = 0; i < 4; ++i) attributes[attributeWidth * v + i] = colors[4 * v + i];
        at = 4;
      }
      for (int set = 0; set < source.UvCount; ++set, at += 2)
      {
        float* uvs = bind.UvSet(set).Pointer;
        for (int v = first; v < first + count; ++v)
        {
          attributes[attributeWidth * v + at] = uvs[2 * v];
          attributes[attributeWidth * v + at + 1] = 1 - uvs[2 * v + 1];
        }
      }
      if (!isSkinned) return;
      CopyRows(bind.Positions.Pointer, source.HasNormals ? bind.Normals.Pointer : null, source.HasTangents ? bind.Tangents.Pointer : null, first, count);
      uint* firstInfluence = bind.FirstInfluence.Pointer;
      Influence* influences = bind.Influences.Pointer;
      for (int v = first; v < first + count; ++v) rows[v] = RowOf(influences + firstInfluence[v], (int)(firstInfluence[v + 1] - firstInfluence[v]));
    }

    /// <summary>The asset keeps at most 4 influences per vertex. Unity wants the strongest first.</summary>
    static SkinRow RowOf(Influence* from, int count)
    {
      SkinRow row = new SkinRow();
      float* weights = &row.Weight0;
      uint* bones = &row.Bone0;
      for (int i = 0; i < count && i < 4; ++i)
      {
        int at = i;
        for (; at > 0 && weights[at - 1] < from[i].Weight; --at)
        {
          weights[at] = weights[at - 1];
          bones[at] = bones[at - 1];
        }
        weights[at] = from[i].Weight;
        bones[at] = from[i].Slot;
      }
      return row;
    }

    // ---- triangles ----

    /// <summary>Returns whether the index buffer is another one.</summary>
    bool CopyTriangles(PosedMesh from)
    {
      UIntView initial = from.InitialTriangles;
      bool isNew = 3 * from.TriangleCapacity > indices.Length;
      if (isNew)
      {
        Array.Resize(ref indices, 3 * from.TriangleCapacity);
        Mesh.SetIndexBufferParams(indices.Length, IndexFormat.UInt32);
      }
      if (initial.Count > 0)
      {
        uint* triangles = initial.Pointer;
        for (int i = 0; i < initial.Count; i += 3) Write(i / 3, triangles[i], triangles[i + 1], triangles[i + 2]);
      }
      if (isNew || initial.Count > 0)
      {
        CopyWrites(from.TriangleWrites, false);
        Mesh.SetIndexBufferData(indices, 0, 0, indices.Length, Flags);
      }
      else
      {
        CopyWrites(from.TriangleWrites, true);
      }
      return isNew;
    }

    void Write(int triangle, uint a, uint b, uint c)
    {
      indices[3 * triangle] = a;
      indices[3 * triangle + 1] = c;
      indices[3 * triangle + 2] = b;
    }

    /// <summary>Places that are close to one another are uploaded at once.</summary>
    void CopyWrites(TriangleWriteView writes, bool uploads)
    {
      int first = 0, last = -1;
      for (int i = 0; i < writes.Count; ++i)
      {
        TriangleWrite write = writes[i];
        int place = (int)write.Place;
        Write(place, write.Vertices.A, write.Vertices.B, write.Vertices.C);
        if (last >= first && (place > last + RunGap || place < first - RunGap))
        {
          if (uploads) UploadTriangles(first, last);
          last = first - 1;
        }
        if (last < first) first = last = place;
        first = Math.Min(first, place);
        last = Math.Max(last, place);
      }
      if (uploads && last >= first) UploadTriangles(first, last);
    }

    void UploadTriangles(int first, int last) { Mesh.SetIndexBufferData(indices, 3 * first, 3 * first, 3 * (last - first + 1), Flags); }

    /// <summary>A submesh of Unity per draw call. Returns whether they need other materials.</summary>
    bool SetRanges(DrawRangeView from, bool hasNewBuffers)
    {
      bool isSame = from.Count == ranges.Length && !hasNewBuffers;
      for (int i = 0; i < from.Count && isSame; ++i)
        isSame = from[i].FirstTriangle == ranges[i].FirstTriangle && from[i].TriangleCount == ranges[i].TriangleCount && from[i].Submesh == ranges[i].Submesh;
      if (isSame) return false;
      if (from.Count != ranges.Length) ranges = new DrawRange[from.Count];
      if (Mesh.subMeshCount != from.Count) Mesh.subMeshCount = from.Count;
      bool hasSameSubmeshes = SubmeshOfRange.Length == from.Count;
      if (SubmeshOfRange.Length != from.Count) SubmeshOfRange = new int[from.Count];
      for (int i = 0; i < from.Count; ++i)
      {
        ranges[i] = from[i];
        hasSameSubmeshes &= SubmeshOfRange[i] == (int)from[i].Submesh;
        SubmeshOfRange[i] = (int)from[i].Submesh;
        SubMeshDescriptor range = new SubMeshDescriptor(3 * (int)from[i].FirstTriangle, 3 * (int)from[i].TriangleCount, MeshTopology.Triangles);
        range.firstVertex = 0;
        range.vertexCount = capacity;
        range.bounds = Mesh.bounds;
        Mesh.SetSubMesh(i, range, Flags);
      }
      return !hasSameSubmeshes;
    }

    // ---- blend shapes that Unity poses ----

    void FollowShapes(MeshView bind, UnityEngine.Mesh like)
    {
      if (Mesh.bindposes.Length == 0) Mesh.bindposes = like.bindposes.Length > 0 ? like.bindposes : new[] { Matrix4x4.identity };
      if (source.Frames.Count == 0) return;
      Mesh.ClearBlendShapes();
      for (int i = 0; i < source.Frames.Count; ++i)
        Mesh.AddBlendShapeFrame(source.Frames[i].Name, source.Frames[i].Weight, Unmirrored(bind.PositionDeltas(i)),
          Unmirrored(bind.NormalDeltas(i)), Unmirrored(bind.TangentDeltas(i)));
    }

    /// <summary>Of all vertices there is room for; null: none.</summary>
    Vector3[] Unmirrored(FloatView from)
    {
      if (from.Count == 0) return null;
      Vector3[] to = new Vector3[capacity];
      float* deltas = from.Pointer;
      for (int i = 0; i < from.Count / 3; ++i) to[i] = new Vector3(-deltas[3 * i], deltas[3 * i + 1], deltas[3 * i + 2]);
      for (int i = from.Count / 3; i < capacity; ++i) to[i] = to[0];
      return to;
    }
  }
}
