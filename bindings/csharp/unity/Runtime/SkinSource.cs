using System;
using System.Collections.Generic;
using UnityEngine;
using UnityEngine.Rendering;

namespace Sunder.Unity
{
  /// <summary>What a SkinnedMeshRenderer draws, as a character of the library. Renderers of one mesh share it, if their bones hang
  /// together in the same way.</summary>
  sealed class SkinSource
  {
    internal const string SubmeshName = "submesh ";

    /// <summary>Per bone of the library: an index in SkinnedMeshRenderer.bones. Parents come first; a bone that stands there twice is one.
    /// Without bones: empty, and the only bone is the renderer itself.</summary>
    internal int[] SlotOfBone;
    /// <summary>Per bone: its parent, or -1.</summary>
    internal int[] Parents;
    /// <summary>One per frame of each blend shape: the library's morph targets.</summary>
    internal readonly List<ShapeFrame> Frames = new List<ShapeFrame>();
    internal int SubmeshCount, UvCount, VertexCount;
    internal bool HasNormals, HasTangents, HasColors;
    internal Character Character;

    internal struct ShapeFrame
    {
      internal int Shape, Frame;
      internal float Weight;
      /// <summary>Of the frame before and after it; 0 and infinity: none.</summary>
      internal float Before, After;
      internal string Name;
    }

    readonly SkinnedMeshRenderer renderer;
    readonly UnityEngine.Mesh mesh;

    /// <summary>most: influences per vertex that are kept, the strongest; 0: all. Throws what is wrong with the renderer.</summary>
    internal SkinSource(SkinnedMeshRenderer renderer, int most)
    {
      this.renderer = renderer;
      mesh = renderer.sharedMesh;
      if (mesh == null) throw new InvalidOperationException(renderer.name + " has no mesh");
      if (!mesh.isReadable) throw new InvalidOperationException("the mesh '" + mesh.name + "' cannot be read: tick Read/Write in its import settings");
      ReadBones();
      CharacterArrays arrays = new CharacterArrays { Name = mesh.name, Bones = MakeBones(), Skins = new[] { MakeSkin() } };
      MeshArrays to = new MeshArrays { Name = mesh.name };
      ReadVertices(to);
      ReadInfluences(to, most);
      ReadTriangles(to);
      ReadShapes(to);
      arrays.Meshes = new[] { to };
      Character = Character.FromArrays(arrays);
    }

    // ---- bones ----

    internal static bool HasBones(SkinnedMeshRenderer renderer) { return renderer.bones.Length > 0; }

    void ReadBones()
    {
      Transform[] bones = renderer.bones;
      if (bones.Length == 0)
      {
        SlotOfBone = new int[0];
        Parents = new[] { -1 };
        return;
      }
      int poses = mesh.bindposes.Length;
      if (poses < bones.Length)
        throw new InvalidOperationException("the mesh '" + mesh.name + "' has " + poses + " bind poses for " + bones.Length + " bones");
      List<int> order = new List<int>();
      Dictionary<Transform, int> first = new Dictionary<Transform, int>();
      for (int i = 0; i < bones.Length; ++i)
      {
        if (bones[i] == null) throw new InvalidOperationException("bone " + i + " of " + renderer.name + " is missing");
        if (first.ContainsKey(bones[i])) continue;
        first.Add(bones[i], i);
        order.Add(i);
      }
      int[] depth = new int[bones.Length];
      foreach (int i in order)
        for (Transform t = bones[i].parent; t != null; t = t.parent) ++depth[i];
      order.Sort((a, b) => depth[a] != depth[b] ? depth[a].CompareTo(depth[b]) : a.CompareTo(b));
      SlotOfBone = order.ToArray();
      Parents = ParentsOf(renderer, SlotOfBone);
    }

    /// <summary>Per bone: the nearest of the bones above it, or -1; null if the renderer has other bones.</summary>
    static int[] ParentsOf(SkinnedMeshRenderer renderer, int[] slotOfBone)
    {
      Transform[] bones = renderer.bones;
      if (slotOfBone.Length == 0) return bones.Length == 0 ? new[] { -1 } : null;
      Dictionary<Transform, int> index = new Dictionary<Transform, int>();
      for (int i = 0; i < slotOfBone.Length; ++i)
      {
        if (slotOfBone[i] >= bones.Length || bones[slotOfBone[i]] == null || index.ContainsKey(bones[slotOfBone[i]])) return null;
        index.Add(bones[slotOfBone[i]], i);
      }
      int[] parents = new int[slotOfBone.Length];
      for (int i = 0; i < parents.Length; ++i)
      {
        parents[i] = -1;
        for (Transform t = bones[slotOfBone[i]].parent; t != null && parents[i] < 0; t = t.parent)
        {
          int parent;
          if (index.TryGetValue(t, out parent)) parents[i] = parent;
        }
      }
      return parents;
    }

    /// <summary>Whether another renderer of the same mesh has bones that hang together in the same way.</summary>
    internal bool Fits(SkinnedMeshRenderer other)
    {
      if (other.bones.Length != renderer.bones.Length) return false;
      int[] parents = ParentsOf(other, SlotOfBone);
      if (parents == null) return false;
      for (int i = 0; i < parents.Length; ++i)
        if (parents[i] != Parents[i]) return false;
      return true;
    }

    internal static Matrix4x4 WorldFromModel(Transform t) { return Matrix4x4.TRS(t.position, t.rotation, Vector3.one); }

    BoneArrays[] MakeBones()
    {
      BoneArrays[] made = new BoneArrays[Parents.Length];
      HashSet<string> names = new HashSet<string>();
      Transform[] bones = renderer.bones;
      Matrix4x4 modelFromWorld = WorldFromModel(renderer.transform).inverse;
      for (int i = 0; i < made.Length; ++i)
      {
        Transform bone = SlotOfBone.Length == 0 ? renderer.transform : bones[SlotOfBone[i]];
        Matrix4x4 parentFromWorld = Parents[i] < 0 ? modelFromWorld : bones[SlotOfBone[Parents[i]]].worldToLocalMatrix;
        string name = string.IsNullOrEmpty(bone.name) ? "bone" : bone.name, unique = name;
        for (int n = 2; !names.Add(unique); ++n) unique = name + " " + n;
        made[i] = new BoneArrays { Name = unique, Parent = Parents[i], Rest = Mirror.ToTransform(parentFromWorld * bone.localToWorldMatrix) };
      }
      return made;
    }

    SkinArrays MakeSkin()
    {
      // Each of these getters makes a copy.
      Transform[] bones = renderer.bones;
      Matrix4x4[] poses = mesh.bindposes;
      Dictionary<Transform, int> index = new Dictionary<Transform, int>();
      for (int bone = 0; bone < SlotOfBone.Length; ++bone) index.Add(bones[SlotOfBone[bone]], bone);
      int slots = Math.Max(1, bones.Length);
      SkinArrays skin = new SkinArrays { Name = mesh.name, Bones = new uint[slots], BoneFromBind = new float[12 * slots] };
      double[] matrix = new double[12];
      for (int slot = 0; slot < slots; ++slot)
      {
        if (bones.Length > 0) skin.Bones[slot] = (uint)index[bones[slot]];
        Mirror.Write(bones.Length == 0 ? Matrix4x4.identity : poses[slot], matrix, 0);
        for (int i = 0; i < 12; ++i) skin.BoneFromBind[12 * slot + i] = (float)matrix[i];
      }
      return skin;
    }

    // ---- vertices ----

    static float[] Mirrored(Vector3[] from)
    {
      float[] to = new float[3 * from.Length];
      for (int i = 0; i < from.Length; ++i)
      {
        to[3 * i] = -from[i].x;
        to[3 * i + 1] = from[i].y;
        to[3 * i + 2] = from[i].z;
      }
      return to;
    }

    void ReadVertices(MeshArrays to)
    {
      Vector3[] normals = mesh.normals;
      Vector4[] tangents = mesh.tangents;
      VertexCount = mesh.vertexCount;
      to.Positions = Mirrored(mesh.vertices);
      HasNormals = normals.Length == VertexCount;
      if (HasNormals) to.Normals = Mirrored(normals);
      HasTangents = HasNormals && tangents.Length == VertexCount;
      if (HasTangents)
      {
        to.Tangents = new float[4 * VertexCount];
        for (int i = 0; i < VertexCount; ++i)
        {
          to.Tangents[4 * i] = -tangents[i].x;
          to.Tangents[4 * i + 1] = tangents[i].y;
          to.Tangents[4 * i + 2] = tangents[i].z;
          to.Tangents[4 * i + 3] = -tangents[i].w;  // the bitangent is a cross product, which a mirror turns
        }
      }
      ReadUvs(to);
      Color[] colors = mesh.colors;
      HasColors = colors.Length == VertexCount && VertexCount > 0;
      if (!HasColors) return;
      float[] set = new float[4 * VertexCount];
      for (int i = 0; i < VertexCount; ++i)
      {
        set[4 * i] = colors[i].r;
        set[4 * i + 1] = colors[i].g;
        set[4 * i + 2] = colors[i].b;
        set[4 * i + 3] = colors[i].a;
      }
      to.ColorSets = new[] { set };
    }

    /// <summary>Sets without a gap from the first on.</summary>
    void ReadUvs(MeshArrays to)
    {
      List<float[]> sets = new List<float[]>();
      List<Vector2> uvs = new List<Vector2>();
      for (int channel = 0; channel < 8 && mesh.HasVertexAttribute(VertexAttribute.TexCoord0 + channel); ++channel)
      {
        mesh.GetUVs(channel, uvs);
        float[] set = new float[2 * VertexCount];
        for (int i = 0; i < VertexCount; ++i)
        {
          set[2 * i] = uvs[i].x;
          set[2 * i + 1] = 1 - uvs[i].y;
        }
        sets.Add(set);
      }
      UvCount = sets.Count;
      to.UvSets = sets.ToArray();
    }

    void ReadInfluences(MeshArrays to, int most)
    {
      List<Influence> influences = new List<Influence>(), row = new List<Influence>();
      to.FirstInfluence = new uint[VertexCount + 1];
      var counts = mesh.GetBonesPerVertex();
      var weights = mesh.GetAllBoneWeights();
      for (int v = 0, at = 0; v < VertexCount; ++v)
      {
        row.Clear();
        for (int i = v < counts.Length && SlotOfBone.Length > 0 ? counts[v] : 0; i > 0; --i, ++at)
          if (weights[at].weight > 0) Add(row, (uint)weights[at].boneIndex, weights[at].weight);
        row.Sort((a, b) => a.Weight != b.Weight ? b.Weight.CompareTo(a.Weight) : a.Slot.CompareTo(b.Slot));
        if (most > 0 && row.Count > most) row.RemoveRange(most, row.Count - most);
        if (row.Count == 0) Add(row, 0, 1);
        Normalize(row);
        influences.AddRange(row);
        to.FirstInfluence[v + 1] = (uint)influences.Count;
      }
      to.Influences = influences.ToArray();
    }

    static void Add(List<Influence> row, uint slot, float weight)
    {
      for (int i = 0; i < row.Count; ++i)
      {
        if (row[i].Slot != slot) continue;
        row[i] = new Influence { Slot = slot, Weight = row[i].Weight + weight };
        return;
      }
      row.Add(new Influence { Slot = slot, Weight = weight });
    }

    static void Normalize(List<Influence> row)
    {
      double sum = 0;
      foreach (Influence one in row) sum += one.Weight;
      for (int i = 0; i < row.Count; ++i) row[i] = new Influence { Slot = row[i].Slot, Weight = (float)(row[i].Weight / sum) };
    }

    void ReadTriangles(MeshArrays to)
    {
      List<uint> triangles = new List<uint>(), submeshes = new List<uint>();
      SubmeshCount = mesh.subMeshCount;
      to.Submeshes = new SubmeshArrays[SubmeshCount];
      for (int s = 0; s < SubmeshCount; ++s)
      {
        if (mesh.GetTopology(s) != MeshTopology.Triangles) throw new InvalidOperationException("submesh " + s + " of '" + mesh.name + "' has no triangles");
        to.Submeshes[s] = new SubmeshArrays { Name = SubmeshName + s, Material = (uint)s };
        int[] indices = mesh.GetTriangles(s);
        for (int i = 0; i + 2 < indices.Length; i += 3)
        {
          triangles.Add((uint)indices[i]);
          triangles.Add((uint)indices[i + 2]);
          triangles.Add((uint)indices[i + 1]);
          submeshes.Add((uint)s);
        }
      }
      to.Triangles = triangles.ToArray();
      to.TriangleSubmesh = submeshes.ToArray();
    }

    void ReadShapes(MeshArrays to)
    {
      List<MorphTargetArrays> targets = new List<MorphTargetArrays>();
      Vector3[] positions = new Vector3[VertexCount], normals = new Vector3[VertexCount], tangents = new Vector3[VertexCount];
      for (int shape = 0; shape < mesh.blendShapeCount; ++shape)
      {
        int count = mesh.GetBlendShapeFrameCount(shape);
        string name = mesh.GetBlendShapeName(shape);
        for (int frame = 0; frame < count; ++frame)
        {
          mesh.GetBlendShapeFrameVertices(shape, frame, positions, normals, tangents);
          string unique = count == 1 ? name : name + " " + frame;
          targets.Add(new MorphTargetArrays { Name = unique, PositionDeltas = Mirrored(positions),
            NormalDeltas = HasNormals ? Mirrored(normals) : null, TangentDeltas = HasTangents ? Mirrored(tangents) : null });
          Frames.Add(new ShapeFrame { Shape = shape, Frame = frame, Name = name, Weight = mesh.GetBlendShapeFrameWeight(shape, frame),
            Before = frame == 0 ? 0 : mesh.GetBlendShapeFrameWeight(shape, frame - 1),
            After = frame + 1 == count ? float.PositiveInfinity : mesh.GetBlendShapeFrameWeight(shape, frame + 1) });
        }
      }
      to.MorphTargets = targets.ToArray();
    }

    // ---- the pose ----

    /// <summary>model_from_bone of all bones: model space has the place and rotation of the renderer's transform, without its scale, so
    /// that a metre is a metre.</summary>
    internal void ReadPose(Transform model, Transform[] bones, double[] matrices)
    {
      Matrix4x4 modelFromWorld = WorldFromModel(model).inverse;
      for (int i = 0; i < Parents.Length; ++i)
        Mirror.Write(modelFromWorld * (SlotOfBone.Length == 0 ? model : bones[SlotOfBone[i]]).localToWorldMatrix, matrices, 12 * i);
    }

    /// <summary>Weights of blend shapes as weights of morph targets: between two frames of a shape both count, beyond the last it goes on.</summary>
    internal void ReadShapeWeights(SkinnedMeshRenderer from, float[] weights)
    {
      for (int i = 0; i < weights.Length; ++i)
      {
        ShapeFrame frame = Frames[i];
        float weight = from.GetBlendShapeWeight(frame.Shape);
        if (weight <= frame.Weight || float.IsPositiveInfinity(frame.After))
          weights[i] = weight <= frame.Before && frame.Before > 0 ? 0 : (weight - frame.Before) / Math.Max(frame.Weight - frame.Before, 1e-6f);
        else
          weights[i] = weight >= frame.After ? 0 : (frame.After - weight) / Math.Max(frame.After - frame.Weight, 1e-6f);
      }
    }
  }
}
