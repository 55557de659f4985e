using System;
using System.Collections.Generic;
using UnityEngine;
using UnityEngine.Rendering;

namespace Sunder.Unity
{
  /// <summary>A piece that came off, as a rigid body: its mesh, convex colliders, mass and inertia. It does not bend any more.</summary>
  [AddComponentMenu("")]
  public sealed class PieceBody : MonoBehaviour
  {
    UnityEngine.Mesh mesh;
    readonly List<UnityEngine.Mesh> hulls = new List<UnityEngine.Mesh>();

    /// <summary>Makes the body where the piece came off, in the pose of then, and disposes the piece.</summary>
    public static PieceBody Make(TearableCharacter character, Piece piece, int mostHulls = 8, int mostPoints = 64)
    {
      if (character == null) throw new ArgumentNullException("character");
      if (piece == null) throw new ArgumentNullException("piece");
      using (piece)
      using (Character part = piece.ToCharacter())
      {
        PieceInfo info = piece.Info;
        Matrix4x4 modelFromPiece = Mirror.ToUnity(info.ModelFromPiece);
        GameObject made = new GameObject(character.name + " (piece)");
        made.layer = character.gameObject.layer;
        made.transform.SetPositionAndRotation(character.ToWorld(new Vector3d(info.ModelFromPiece[0, 3], info.ModelFromPiece[1, 3], info.ModelFromPiece[2, 3])),
          character.transform.rotation * modelFromPiece.rotation);
        PieceBody body = made.AddComponent<PieceBody>();
        body.MakeMesh(character, part);
        if ((Library.Features & Features.Hulls) != 0) body.MakeColliders(piece.GetHulls(mostHulls, mostPoints));
        body.MakeRigidbody(info, modelFromPiece);
        return body;
      }
    }

    void MakeMesh(TearableCharacter character, Character part)
    {
      MeshView from = part.GetMesh(0);
      mesh = new UnityEngine.Mesh { name = name, indexFormat = IndexFormat.UInt32 };
      mesh.vertices = Unmirrored(from.Positions);
      if (from.Normals.Count > 0) mesh.normals = Unmirrored(from.Normals);
      if (from.Tangents.Count > 0) mesh.tangents = UnmirroredTangents(from.Tangents);
      for (int set = 0; set < from.UvSetCount; ++set)
      {
        FloatView uvs = from.UvSet(set);
        List<Vector2> to = new List<Vector2>(from.VertexCount);
        for (int v = 0; v < from.VertexCount; ++v) to.Add(new Vector2(uvs[2 * v], 1 - uvs[2 * v + 1]));
        mesh.SetUVs(set, to);
      }
      if (from.ColorSetCount > 0)
      {
        FloatView colors = from.ColorSet(0);
        Color[] to = new Color[from.VertexCount];
        for (int v = 0; v < to.Length; ++v) to[v] = new Color(colors[4 * v], colors[4 * v + 1], colors[4 * v + 2], colors[4 * v + 3]);
        mesh.colors = to;
      }
      List<Material> materials = new List<Material>();
      List<int[]> submeshes = new List<int[]>();
      for (int s = 0; s < from.SubmeshCount; ++s)
      {
        int[] triangles = TrianglesOf(from, (uint)s);
        if (triangles.Length == 0) continue;
        submeshes.Add(triangles);
        materials.Add(character.MaterialOf(from.SubmeshName(s), from.SubmeshMaterial(s)));
      }
      mesh.subMeshCount = submeshes.Count;
      for (int s = 0; s < submeshes.Count; ++s) mesh.SetTriangles(submeshes[s], s);
      mesh.RecalculateBounds();
      gameObject.AddComponent<MeshFilter>().sharedMesh = mesh;
      gameObject.AddComponent<MeshRenderer>().sharedMaterials = materials.ToArray();
    }

    static int[] TrianglesOf(MeshView from, uint submesh)
    {
      UIntView triangles = from.Triangles, submeshes = from.TriangleSubmesh;
      List<int> to = new List<int>();
      for (int t = 0; t < from.TriangleCount; ++t)
      {
        if (submeshes[t] != submesh || triangles[3 * t] == triangles[3 * t + 1] && triangles[3 * t] == triangles[3 * t + 2]) continue;
        to.Add((int)triangles[3 * t]);
        to.Add((int)triangles[3 * t + 2]);
        to.Add((int)triangles[3 * t + 1]);
      }
      return to.ToArray();
    }

    static Vector3[] Unmirrored(FloatView from)
    {
      Vector3[] to = new Vector3[from.Count / 3];
      for (int v = 0; v < to.Length; ++v) to[v] = new Vector3(-from[3 * v], from[3 * v + 1], from[3 * v + 2]);
      return to;
    }

    static Vector4[] UnmirroredTangents(FloatView from)
    {
      Vector4[] to = new Vector4[from.Count / 4];
      for (int v = 0; v < to.Length; ++v) to[v] = new Vector4(-from[4 * v], from[4 * v + 1], from[4 * v + 2], -from[4 * v + 3]);
      return to;
    }

    void MakeColliders(ConvexHull[] convex)
    {
      foreach (ConvexHull one in convex)
      {
        Vector3[] points = new Vector3[one.Points.Length / 3];
        for (int i = 0; i < points.Length; ++i) points[i] = Mirror.ToUnity(new Vector3d(one.Points[3 * i], one.Points[3 * i + 1], one.Points[3 * i + 2]));
        int[] triangles = new int[one.Triangles.Length];
        for (int i = 0; i < triangles.Length; i += 3)
        {
          triangles[i] = (int)one.Triangles[i];
          triangles[i + 1] = (int)one.Triangles[i + 2];
          triangles[i + 2] = (int)one.Triangles[i + 1];
        }
        UnityEngine.Mesh hull = new UnityEngine.Mesh { name = name + " hull", vertices = points };
        hull.SetTriangles(triangles, 0);
        hulls.Add(hull);
        MeshCollider collider = gameObject.AddComponent<MeshCollider>();
        collider.convex = true;
        collider.sharedMesh = hull;
      }
    }

    /// <summary>The axes of a piece are the principal ones, so its inertia is diagonal.</summary>
    void MakeRigidbody(PieceInfo info, Matrix4x4 modelFromPiece)
    {
      Rigidbody rigid = gameObject.AddComponent<Rigidbody>();
      rigid.mass = (float)info.Mass;
      rigid.centerOfMass = modelFromPiece.inverse.MultiplyPoint3x4(Mirror.ToUnity(info.Centre));
      rigid.inertiaTensor = new Vector3((float)info.InertiaPiece[0, 0], (float)info.InertiaPiece[1, 1], (float)info.InertiaPiece[2, 2]);
      rigid.inertiaTensorRotation = Quaternion.identity;
    }

    void OnDestroy()
    {
      Destroy(mesh);
      foreach (UnityEngine.Mesh hull in hulls) Destroy(hull);
    }
  }
}
