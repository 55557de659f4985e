using System;
using System.Collections.Generic;
using Sunder.Unity;
using UnityEngine;
using UnityEngine.Rendering;

namespace Sunder.Tests
{
  /// <summary>A tube of Unity on three bones under a transform that is moved, turned and scaled; two submeshes, two blend shapes.</summary>
  sealed class Rig
  {
    internal const int Rings = 24, Sides = 24;
    internal readonly GameObject Object;
    internal readonly SkinnedMeshRenderer Renderer;
    internal readonly UnityEngine.Mesh Mesh;
    internal readonly Transform[] Bones = new Transform[3];
    internal readonly TearableCharacter Character;
    internal readonly Material Skin = new Material("skin"), Cloth = new Material("cloth"), Flesh = new Material("flesh");

    internal Rig(CharacterSkinning skinning, bool isSoft, UnityEngine.Mesh shared = null)
    {
      GameObject root = new GameObject("root");
      root.transform.localPosition = new Vector3(3, 1, -2);
      root.transform.localRotation = Quaternion.AngleAxis(35, new Vector3(0.2f, 1, 0.1f));
      Object = new GameObject("tube");
      Object.transform.parent = root.transform;
      Object.transform.localScale = new Vector3(2, 2, 2);
      Object.transform.localRotation = Quaternion.AngleAxis(-20, new Vector3(1, 0, 0));
      for (int i = 0; i < 3; ++i)
      {
        GameObject bone = new GameObject("bone");  // all of one name
        bone.transform.parent = i == 0 ? root.transform : Bones[i - 1];
        bone.transform.localPosition = new Vector3(0, i == 0 ? 0.1f : 0.7f, 0);
        Bones[i] = bone.transform;
      }
      Mesh = shared ?? MakeMesh();
      Renderer = Object.AddComponent<SkinnedMeshRenderer>();
      Renderer.sharedMesh = Mesh;
      // Not in the order of the hierarchy.
      Renderer.bones = new[] { Bones[2], Bones[0], Bones[1] };
      Renderer.sharedMaterials = new[] { Skin, Cloth };
      Character = Object.AddComponent<TearableCharacter>();
      Character.Skinning = skinning;
      Character.IsSoft = isSoft;
      Character.Flesh = Flesh;
    }

    UnityEngine.Mesh MakeMesh()
    {
      List<Vector3> vertices = new List<Vector3>(), normals = new List<Vector3>();
      List<Vector4> tangents = new List<Vector4>();
      List<Vector2> uvs = new List<Vector2>();
      List<Color> colors = new List<Color>();
      List<byte> counts = new List<byte>();
      List<BoneWeight1> weights = new List<BoneWeight1>();
      for (int ring = 0; ring <= Rings; ++ring)
        for (int side = 0; side <= Sides; ++side)
        {
          double angle = 2 * Math.PI * (side % Sides) / Sides;
          float up = ring / (float)Rings, x = (float)Math.Cos(angle), z = (float)Math.Sin(angle);
          vertices.Add(new Vector3(0.15f * x, up, 0.2f * z));
          float length = new Vector3(x / 0.15f, 0, z / 0.2f).magnitude;
          normals.Add(new Vector3(x / 0.15f / length, 0, z / 0.2f / length));
          tangents.Add(new Vector4(0, 1, 0, -1));
          uvs.Add(new Vector2(side / (float)Sides, up));
          colors.Add(new Color(up, 0.5f, 1 - up, 1));
          AddWeights(up, counts, weights);
        }
      UnityEngine.Mesh mesh = new UnityEngine.Mesh { name = "tube", vertices = vertices.ToArray(), normals = normals.ToArray(), tangents = tangents.ToArray(), colors = colors.ToArray() };
      mesh.SetUVs(0, uvs);
      mesh.BonesPerVertex = counts.ToArray();
      mesh.BoneWeights = weights.ToArray();
      mesh.subMeshCount = 2;
      for (int s = 0; s < 2; ++s)
      {
        List<int> triangles = new List<int>();
        for (int ring = s * Rings / 2; ring < (s + 1) * Rings / 2; ++ring)
          for (int side = 0; side < Sides; ++side)
          {
            int a = ring * (Sides + 1) + side, b = a + 1, c = a + Sides + 1, d = c + 1;
            triangles.AddRange(new[] { a, c, b, b, c, d });  // clockwise from outside
          }
        mesh.SetTriangles(triangles.ToArray(), s);
      }
      mesh.bindposes = new[] { Bones[2].worldToLocalMatrix * Object.transform.localToWorldMatrix, Bones[0].worldToLocalMatrix * Object.transform.localToWorldMatrix,
        Bones[1].worldToLocalMatrix * Object.transform.localToWorldMatrix };
      Vector3[] bulge = new Vector3[vertices.Count], lean = new Vector3[vertices.Count], more = new Vector3[vertices.Count];
      for (int v = 0; v < bulge.Length; ++v)
      {
        bulge[v] = 0.05f * normals[v];
        lean[v] = new Vector3(0.1f * vertices[v].y, 0, 0);
        more[v] = new Vector3(0.15f * vertices[v].y, 0, 0.1f * vertices[v].y);
      }
      mesh.AddBlendShapeFrame("bulge", 100, bulge, null, null);
      mesh.AddBlendShapeFrame("lean", 50, lean, null, null);
      mesh.AddBlendShapeFrame("lean", 100, more, null, null);
      mesh.RecalculateBounds();
      return mesh;
    }

    /// <summary>Three bones along the tube; some vertices list one twice.</summary>
    static void AddWeights(float up, List<byte> counts, List<BoneWeight1> weights)
    {
      float top = Math.Max(0, 2 * up - 1), low = Math.Max(0, 1 - 2 * up), middle = 1 - top - low;
      int before = weights.Count;
      if (middle > 0)
      {
        weights.Add(new BoneWeight1 { boneIndex = 2, weight = 0.5f * middle });
        weights.Add(new BoneWeight1 { boneIndex = 2, weight = 0.5f * middle });
      }
      if (top > 0) weights.Add(new BoneWeight1 { boneIndex = 0, weight = top });
      if (low > 0) weights.Add(new BoneWeight1 { boneIndex = 1, weight = low });
      counts.Add((byte)(weights.Count - before));
    }

    internal void Bend(float degrees)
    {
      Bones[1].localRotation = Quaternion.AngleAxis(degrees, new Vector3(0.3f, 0, 1));
      Bones[2].localRotation = Quaternion.AngleAxis(0.7f * degrees, new Vector3(1, 0.2f, 0));
      Bones[2].localScale = new Vector3(1.1f, 0.9f, 1);
    }

    static float ShapeShare(float weight, float before, float at, float after)
    {
      if (weight <= at || after <= at) return before > 0 && weight < before ? 0 : (weight - before) / (at - before);
      return Math.Max(0, (after - weight) / (after - at));
    }

    /// <summary>What Unity draws, by the definition, in world space.</summary>
    internal Vector3[] Posed(UnityEngine.Mesh mesh, Func<int, int, float> weightOf)
    {
      Vector3[] vertices = mesh.vertices, delta = new Vector3[vertices.Length], unused = new Vector3[vertices.Length], posed = new Vector3[vertices.Length];
      float bulge = Renderer.GetBlendShapeWeight(0), lean = Renderer.GetBlendShapeWeight(1);
      float[] shares = { bulge / 100, ShapeShare(lean, 0, 50, 100), ShapeShare(lean, 50, 100, 0) };
      for (int f = 0; f < 3; ++f)
      {
        mesh.GetBlendShapeFrameVertices(f == 0 ? 0 : 1, f == 2 ? 1 : 0, delta, unused, unused);
        for (int v = 0; v < vertices.Length; ++v) vertices[v] += shares[f] * delta[v];
      }
      Matrix4x4[] worldFromBind = new Matrix4x4[3];
      for (int slot = 0; slot < 3; ++slot) worldFromBind[slot] = Renderer.bones[slot].localToWorldMatrix * mesh.bindposes[slot];
      for (int v = 0; v < posed.Length; ++v)
        for (int slot = 0; slot < 3; ++slot) posed[v] += weightOf(v, slot) * worldFromBind[slot].MultiplyPoint3x4(vertices[v]);
      return posed;
    }

    internal float SourceWeight(int vertex, int slot)
    {
      int at = 0;
      for (int v = 0; v < vertex; ++v) at += Mesh.BonesPerVertex[v];
      float sum = 0;
      for (int i = at; i < at + Mesh.BonesPerVertex[vertex]; ++i)
        if (Mesh.BoneWeights[i].boneIndex == slot) sum += Mesh.BoneWeights[i].weight;
      return sum;
    }

    /// <summary>In the buffers of a mesh that Unity skins.</summary>
    internal static float BufferWeight(UnityEngine.Mesh mesh, int vertex, int slot)
    {
      float sum = 0;
      for (int i = 0; i < 4; ++i)
        if (mesh.ReadUInt(VertexAttribute.BlendIndices, vertex, i) == slot) sum += mesh.Read(VertexAttribute.BlendWeight, vertex, i);
      return sum;
    }

    /// <summary>The transform of what draws.</summary>
    internal Vector3 Drawn(int vertex)
    {
      return Character.Renderer.transform.localToWorldMatrix.MultiplyPoint3x4(Character.Mesh.ReadVector(VertexAttribute.Position, vertex));
    }
  }
}
