using System;
using System.Collections.Generic;
using Sunder.Unity;
using UnityEngine;
using UnityEngine.Rendering;

namespace Sunder.Tests
{
  /// <summary>The package in a host of stubs: what the graphics card gets is what the definition of skinning and the library say.</summary>
  static class UnityTests
  {
    const float Near = 2e-5f;

    static void ExpectNear(Vector3 have, Vector3 want, float most, string what)
    {
      Expect.That((have - want).magnitude <= most, what + ": " + have + " is not " + want);
    }

    static void Pose(Rig rig, float degrees)
    {
      rig.Bend(degrees);
      rig.Renderer.SetBlendShapeWeight(0, degrees);
      rig.Renderer.SetBlendShapeWeight(1, 1.6f * degrees);
      Host.Frame();
    }

    /// <summary>Sweeps a blade through the side of the tube.</summary>
    static Blade Sweep(Rig rig, int frames, float width, float wallDepth)
    {
      Blade blade = new GameObject("blade").AddComponent<Blade>();
      blade.EdgeBase = new Vector3(0, 0, 0);
      blade.EdgeTip = new Vector3(0, 0, 0.55f);
      blade.Width = width;
      blade.WallDepth = wallDepth;
      blade.MinimumDistance = 0.01f;
      for (int i = 0; i <= frames; ++i)
      {
        Transform at = blade.gameObject.transform;
        at.localRotation = rig.Object.transform.rotation;
        at.localPosition = rig.Object.transform.TransformPoint(new Vector3(-0.4f + 0.8f * i / frames, 0.55f, -0.3f));
        Host.Frame();
      }
      UnityEngine.Object.Destroy(blade);
      Host.Frame();
      return blade;
    }

    // ---- the layer ----

    internal static void PosedPositionsAgree()
    {
      Rig rig = new Rig(CharacterSkinning.BySunder, false);
      foreach (float degrees in new[] { 0f, 25f, 55f, -40f })
      {
        Pose(rig, degrees);
        Vector3[] want = rig.Posed(rig.Mesh, rig.SourceWeight);
        for (int v = 0; v < want.Length; ++v) ExpectNear(rig.Drawn(v), want[v], Near, "vertex " + v + " at " + degrees + " degrees");
        ExpectOutside(rig);
        ExpectBounds(rig);
      }
      Expect.That(!rig.Renderer.enabled && rig.Character.Renderer is MeshRenderer, "another renderer draws");
      SubMeshDescriptor first = rig.Character.Mesh.GetSubMesh(0);
      for (int t = 0; t < first.indexCount / 3; ++t) ExpectSameTriangle(rig, first.indexStart + 3 * t, 3 * t);
      Expect.Equal(string.Join(" ", Array.ConvertAll(rig.Character.Renderer.sharedMaterials, m => m.name)), "skin cloth", "materials");
      UnityEngine.Object.Destroy(rig.Object);
      Expect.That(rig.Renderer == null && TearScene.Current.CharacterCount == 0, "it is gone");
    }

    static void ExpectSameTriangle(Rig rig, int drawn, int source)
    {
      int[] wanted = rig.Mesh.GetTriangles(0);
      int at = -1;
      for (int i = 0; i < 3; ++i)
        if (rig.Character.Mesh.ReadIndex(drawn + i) == wanted[source]) at = i;
      for (int i = 0; i < 3; ++i)
        Expect.That(at >= 0 && rig.Character.Mesh.ReadIndex(drawn + (at + i) % 3) == wanted[source + i], "triangle at index " + source);
    }

    /// <summary>Triangles that are drawn turn clockwise, and normals and tangents are those of the surface. Skips walls.</summary>
    static void ExpectOutside(Rig rig)
    {
      UnityEngine.Mesh mesh = rig.Character.Mesh;
      int checkedTriangles = 0;
      for (int s = 0; s < 2; ++s)
      {
        SubMeshDescriptor range = mesh.GetSubMesh(s);
        for (int i = range.indexStart; i < range.indexStart + range.indexCount; i += 3)
        {
          int a = (int)mesh.ReadIndex(i), b = (int)mesh.ReadIndex(i + 1), c = (int)mesh.ReadIndex(i + 2);
          Vector3 at = mesh.ReadVector(VertexAttribute.Position, a);
          Vector3 outside = Vector3.Cross(mesh.ReadVector(VertexAttribute.Position, b) - at, mesh.ReadVector(VertexAttribute.Position, c) - at);
          if (outside.magnitude < 1e-6f) continue;
          Vector3 normal = mesh.ReadVector(VertexAttribute.Normal, a), tangent = mesh.ReadVector(VertexAttribute.Tangent, a);
          Expect.That(Vector3.Dot(outside, normal) > 0.5f * outside.magnitude, "triangle at index " + i + " turns to the outside");
          Expect.Near(normal.magnitude, 1, 1e-4, "length of normal " + a);
          Expect.Equal(mesh.Read(VertexAttribute.Tangent, a, 3), -1f, "sign of tangent " + a);
          Expect.That(Math.Abs(Vector3.Dot(normal, tangent)) < 0.2f, "tangent " + a);
          ++checkedTriangles;
        }
      }
      Expect.That(checkedTriangles > 1000, "triangles were checked");
    }

    static void ExpectBounds(Rig rig)
    {
      UnityEngine.Mesh mesh = rig.Character.Mesh;
      Bounds bounds = mesh.bounds;
      foreach (Vector3 v in mesh.vertices)
        Expect.That(Math.Abs(v.x - bounds.center.x) <= bounds.extents.x + Near && Math.Abs(v.y - bounds.center.y) <= bounds.extents.y + Near
          && Math.Abs(v.z - bounds.center.z) <= bounds.extents.z + Near, "a vertex within the bounds");
    }

    /// <summary>What the buffers have is what the library has: all vertices, triangles, draw calls and attributes.</summary>
    static void ExpectBuffers(Rig rig)
    {
      UnityEngine.Mesh mesh = rig.Character.Mesh;
      PosedMesh posed = rig.Character.Instance.GetPosedMesh();
      MeshView bind = rig.Character.Instance.GetMesh();
      FloatView positions = posed.Positions.Count > 0 ? posed.Positions : bind.Positions, uvs = bind.UvSet(0), colors = bind.ColorSet(0);
      for (int v = 0; v < bind.VertexCount; ++v)
      {
        ExpectNear(mesh.ReadVector(VertexAttribute.Position, v), new Vector3(-positions[3 * v], positions[3 * v + 1], positions[3 * v + 2]), 0, "position " + v);
        Expect.Equal(mesh.Read(VertexAttribute.TexCoord0, v, 0), uvs[2 * v], "u of " + v);
        Expect.Equal(mesh.Read(VertexAttribute.TexCoord0, v, 1), 1 - uvs[2 * v + 1], "v of " + v);
        for (int i = 0; i < 4; ++i) Expect.Equal(mesh.Read(VertexAttribute.Color, v, i), colors[4 * v + i], "colour of " + v);
      }
      uint[] triangles = new uint[3 * posed.TriangleCapacity];
      posed.InitialTriangles.CopyTo(triangles);
      for (int i = 0; i < posed.TriangleWrites.Count; ++i)
      {
        TriangleWrite write = posed.TriangleWrites[i];
        triangles[3 * write.Place] = write.Vertices.A;
        triangles[3 * write.Place + 1] = write.Vertices.B;
        triangles[3 * write.Place + 2] = write.Vertices.C;
      }
      Expect.Equal(mesh.subMeshCount, posed.DrawRanges.Count, "draw calls");
      for (int r = 0; r < mesh.subMeshCount; ++r)
      {
        DrawRange range = posed.DrawRanges[r];
        Expect.Equal(mesh.GetSubMesh(r).indexStart + " " + mesh.GetSubMesh(r).indexCount, 3 * range.FirstTriangle + " " + 3 * range.TriangleCount, "draw call " + r);
        for (int t = (int)range.FirstTriangle; t < range.FirstTriangle + range.TriangleCount; ++t)
          Expect.That(mesh.ReadIndex(3 * t) == triangles[3 * t] && mesh.ReadIndex(3 * t + 1) == triangles[3 * t + 2] && mesh.ReadIndex(3 * t + 2) == triangles[3 * t + 1], "triangle " + t);
      }
    }

    internal static void BladeTears()
    {
      Rig rig = new Rig(CharacterSkinning.BySunder, false);
      List<TearInfo> torn = new List<TearInfo>();
      rig.Character.Torn.AddListener((who, info) => { if (who == rig.Character) torn.Add(info); });
      string failure = "";
      rig.Character.Failed.AddListener((who, text) => { failure = text; });
      Pose(rig, 20);
      int before = rig.Mesh.vertexCount;
      Sweep(rig, 60, 0.01f, 0.05f);
      Expect.That(torn.Count > 5 && torn[0].VerticesAdded > 0, "events: " + torn.Count);
      Expect.Equal(failure, "", "what failed");
      Expect.That(rig.Character.Instance.GetPosedMesh().VertexCount > before + 50, "new vertices");
      ExpectBuffers(rig);
      ExpectOutside(rig);
      ExpectMaterials(rig);
      Pose(rig, 45);
      ExpectBuffers(rig);
      ExpectBounds(rig);
      ulong digest = rig.Character.Instance.Digest;
      rig.Character.Undo();
      Host.Frame();
      ExpectBuffers(rig);
      rig.Character.Redo();
      Host.Frame();
      ExpectBuffers(rig);
      Expect.Equal(rig.Character.Instance.Digest, digest, "redone");
      ExpectWhereTheBladeWas(rig);
      UnityEngine.Object.Destroy(rig.Object);
    }

    /// <summary>Per draw call: that of its submesh, and flesh for walls.</summary>
    static void ExpectMaterials(Rig rig)
    {
      Material[] materials = rig.Character.Renderer.sharedMaterials;
      DrawRangeView ranges = rig.Character.Instance.GetPosedMesh().DrawRanges;
      Expect.Equal(materials.Length, ranges.Count, "materials");
      for (int i = 0; i < materials.Length; ++i)
        Expect.That(materials[i] == (ranges[i].Submesh == 0 ? rig.Skin : ranges[i].Submesh == 1 ? rig.Cloth : rig.Flesh), "material " + i);
      Expect.That(materials[materials.Length - 1] == rig.Flesh, "walls");
    }

    /// <summary>New vertices lie where the blade went, in the space of Unity: a mirrored tear would be on the other side.</summary>
    static void ExpectWhereTheBladeWas(Rig rig)
    {
      MeshView bind = rig.Character.Instance.GetMesh();
      FloatView positions = bind.Positions;
      for (int v = rig.Mesh.vertexCount; v < bind.VertexCount; ++v)
      {
        Expect.That(positions[3 * v + 2] < 0.1f, "vertex " + v + " is on the side of the blade");
        Expect.Near(positions[3 * v + 1], 0.55, 0.15, "height of vertex " + v);
      }
    }

    internal static void OneSidedTear()
    {
      // Only at x > 0 of Unity's space.
      Rig rig = new Rig(CharacterSkinning.BySunder, false);
      Host.Frame();
      Vector3[] bases = new Vector3[6], tips = new Vector3[6];
      for (int i = 0; i < 6; ++i)
      {
        bases[i] = rig.Object.transform.TransformPoint(new Vector3(0.3f, 0.3f + 0.03f * i, 0.05f));
        tips[i] = rig.Object.transform.TransformPoint(new Vector3(0.05f, 0.3f + 0.03f * i, 0.05f));
      }
      Command command = rig.Character.Tear(bases, tips);
      Host.Frame();
      Expect.That(command.Result.VerticesAdded > 0, "torn");
      UnityEngine.Mesh mesh = rig.Character.Mesh;
      Matrix4x4 localFromDrawn = rig.Object.transform.worldToLocalMatrix * rig.Character.Renderer.transform.localToWorldMatrix;
      int count = rig.Character.Instance.GetPosedMesh().VertexCount;
      for (int v = rig.Mesh.vertexCount; v < count; ++v)
      {
        Vector3 at = localFromDrawn.MultiplyPoint3x4(mesh.ReadVector(VertexAttribute.Position, v));
        Expect.That(at.x > 0.05f && at.y > 0.25f && at.y < 0.5f && at.z > 0, "vertex " + v + " at " + at);
      }
      TearHit hit;
      Vector3 from = rig.Object.transform.TransformPoint(new Vector3(0.5f, 0.7f, 0)), to = rig.Object.transform.TransformPoint(new Vector3(0, 0.7f, 0));
      Expect.That(rig.Character.Raycast(new Ray(from, (1 / (to - from).magnitude) * (to - from)), 5, out hit), "a ray meets it");
      ExpectNear(hit.Point, rig.Object.transform.TransformPoint(new Vector3(0.15f, 0.7f, 0)), 0.01f, "place of the ray");
      Expect.That(Vector3.Dot(hit.Normal, from - to) > 0.9f * (from - to).magnitude && hit.Bone == rig.Bones[1], "normal and bone of the ray");
      rig.Character.Drill(from, to - from, 0.02f, 5);
      Host.Frame();
      ExpectBuffers(rig);
      UnityEngine.Object.Destroy(rig.Object);
    }

    internal static void UnitySkinsAsTheLibrary()
    {
      Rig unity = new Rig(CharacterSkinning.ByUnity, false);
      Rig sunder = new Rig(CharacterSkinning.BySunder, false);
      Pose(unity, 20);
      Pose(sunder, 20);
      foreach (Rig rig in new[] { unity, sunder })
      {
        Vector3[] bases = new Vector3[9], tips = new Vector3[9];
        for (int i = 0; i < 9; ++i)
        {
          bases[i] = rig.Object.transform.TransformPoint(new Vector3(-0.12f + 0.03f * i, 0.62f, -0.4f));
          tips[i] = rig.Object.transform.TransformPoint(new Vector3(-0.12f + 0.03f * i, 0.62f, 0));
        }
        TearOptions options = TearOptions.Default;
        options.Width = 0.02;
        options.WallDepth = 0.05;
        rig.Character.Tear(bases, tips, options);
      }
      Host.Frame();
      Expect.That(unity.Renderer.enabled && unity.Renderer.sharedMesh == unity.Character.Mesh, "Unity draws the torn mesh");
      ExpectBuffers(unity);
      ExpectBuffers(sunder);
      int count = unity.Character.Instance.GetMesh().VertexCount;
      Expect.Equal(count, sunder.Character.Instance.GetPosedMesh().VertexCount, "vertices");
      Expect.That(count > unity.Mesh.vertexCount, "torn");
      foreach (float degrees in new[] { 0f, 30f, 60f })
      {
        Pose(unity, degrees);
        Pose(sunder, degrees);
        UnityEngine.Mesh mesh = unity.Character.Mesh;
        Vector3[] posed = unity.Posed(mesh, (v, slot) => Rig.BufferWeight(mesh, v, slot));
        for (int v = 0; v < count; ++v)
        {
          ExpectNear(posed[v], sunder.Drawn(v), Near, "vertex " + v + " at " + degrees + " degrees");
          float sum = 0;
          for (int i = 0; i < 4; ++i) sum += mesh.Read(VertexAttribute.BlendWeight, v, i);
          Expect.Near(sum, 1, 1e-5, "weights of " + v);
          for (int i = 1; i < 4; ++i) Expect.That(mesh.Read(VertexAttribute.BlendWeight, v, i) <= mesh.Read(VertexAttribute.BlendWeight, v, i - 1), "the strongest first");
        }
      }
      UnityEngine.Mesh torn = unity.Character.Mesh;
      UnityEngine.Object.Destroy(unity.Object.GetComponent<TearableCharacter>());
      Expect.That(unity.Renderer.sharedMesh == unity.Mesh && torn == null, "the renderer has its mesh again");
      UnityEngine.Object.Destroy(sunder.Object);
    }

    internal static void ManyTearsGrowTheBuffers()
    {
      foreach (CharacterSkinning skinning in new[] { CharacterSkinning.BySunder, CharacterSkinning.ByUnity })
      {
        Rig rig = new Rig(skinning, false);
        Host.Frame();
        for (int i = 0; i < 25; ++i)
        {
          float y = 0.08f + 0.035f * i;
          rig.Character.Cut(rig.Object.transform.TransformPoint(new Vector3(0, y, 0)), rig.Object.transform.rotation * new Vector3(0.3f, 1, 0.1f * (i % 5)));
          Pose(rig, i);
          ExpectBuffers(rig);
        }
        for (int i = 0; i < 25; ++i)
        {
          rig.Character.Undo();
          Host.Frame();
          ExpectBuffers(rig);
        }
        Expect.Equal(rig.Character.Instance.GetMesh().VertexCount, rig.Mesh.vertexCount, "all is undone");
        UnityEngine.Object.Destroy(rig.Object);
      }
    }

    internal static void PiecesFall()
    {
      Rig rig = new Rig(CharacterSkinning.BySunder, false);
      PieceBody body = null;
      rig.Character.Detached.AddListener((who, piece) => { body = PieceBody.Make(who, piece); });
      Pose(rig, 30);
      Vector3 middle = 0.5f * (rig.Drawn(14 * (Rig.Sides + 1)) + rig.Drawn(14 * (Rig.Sides + 1) + Rig.Sides / 2));
      Command cut = rig.Character.Cut(middle, rig.Bones[1].rotation * new Vector3(0, 1, 0));
      Host.Frame();
      Expect.That(cut.Result.Caps == 2 && cut.Result.OpenSections == 0, "caps");
      Vector3 top = rig.Drawn(Rig.Rings * (Rig.Sides + 1));
      HashSet<string> drawnBefore = new HashSet<string>();
      int vertices = rig.Character.Instance.GetPosedMesh().VertexCount;
      for (int v = 0; v < vertices; ++v) drawnBefore.Add(Rounded(rig.Drawn(v)));
      rig.Character.Detach(top);
      Host.Frame();
      ExpectBuffers(rig);
      Expect.That(body != null, "a body was made");
      UnityEngine.Mesh mesh = body.gameObject.GetComponent<MeshFilter>().sharedMesh;
      int found = 0;
      foreach (Vector3 v in mesh.vertices)
        if (drawnBefore.Contains(Rounded(body.transform.localToWorldMatrix.MultiplyPoint3x4(v)))) ++found;
      Expect.That(found > 0.9 * mesh.vertexCount && mesh.vertexCount > 50, found + " of " + mesh.vertexCount + " vertices of the piece stand where they were drawn");
      Vector3[] at = mesh.vertices, normals = mesh.normals;
      int turned = 0;
      int[] outer = mesh.GetTriangles(0);
      for (int i = 0; i < outer.Length; i += 3)
        if (Vector3.Dot(Vector3.Cross(at[outer[i + 1]] - at[outer[i]], at[outer[i + 2]] - at[outer[i]]), normals[outer[i]]) < 0) ++turned;
      Expect.Equal(turned, 0, "triangles of the piece that turn inwards");
      string[] names = Array.ConvertAll(body.gameObject.GetComponent<MeshRenderer>().sharedMaterials, m => m.name);
      Expect.That(names[0] == "cloth" && names[names.Length - 1] == "flesh", "materials: " + string.Join(" ", names));
      Rigidbody rigid = body.gameObject.GetComponent<Rigidbody>();
      Expect.That(rigid.mass > 1 && rigid.inertiaTensor.x > 0 && rigid.inertiaTensor.y > 0 && rigid.inertiaTensor.z > 0, "mass and inertia");
      Vector3 centre = body.transform.TransformPoint(rigid.centerOfMass);
      Bounds bounds = new Bounds(body.transform.TransformPoint(mesh.vertices[0]), Vector3.zero);
      foreach (Vector3 v in mesh.vertices) bounds.Encapsulate(body.transform.TransformPoint(v));
      Expect.That(bounds.Intersects(new Bounds(centre, Vector3.zero)), "the centre of mass is inside");
      MeshCollider collider = body.gameObject.GetComponent<MeshCollider>();
      foreach (Vector3 v in collider.sharedMesh.vertices)
      {
        Bounds room = mesh.bounds;
        room.extents = 1.01f * room.extents;
        Expect.That(room.Intersects(new Bounds(v, Vector3.zero)), "a collider is where the piece is");
      }
      UnityEngine.Object.Destroy(body.gameObject);
      UnityEngine.Object.Destroy(rig.Object);
    }

    static string Rounded(Vector3 v) { return Math.Round(v.x * 1e3) + " " + Math.Round(v.y * 1e3) + " " + Math.Round(v.z * 1e3); }

    internal static void CharactersShareAssets()
    {
      Rig one = new Rig(CharacterSkinning.BySunder, false), other = new Rig(CharacterSkinning.BySunder, false, one.Mesh);
      Host.Frame();
      Expect.That(one.Character.Instance.Asset == other.Character.Instance.Asset, "one asset for two characters of one mesh");
      one.Character.enabled = false;
      Expect.Equal(TearScene.Current.CharacterCount, 1, "characters that are updated");
      one.Character.enabled = true;
      Host.Frame();
      ExpectBuffers(one);
      UnityEngine.Object.Destroy(one.Object);
      Host.Frame();
      ExpectBuffers(other);
      Expect.That(one.Character.Instance == null, "a destroyed character has no instance");
      UnityEngine.Object.Destroy(other.Object);
    }

    internal static void FaultsHaveTexts()
    {
      Rig rig = new Rig(CharacterSkinning.BySunder, false);
      rig.Mesh.IsReadable = false;
      Expect.Throws<InvalidOperationException>(() => { Instance instance = rig.Character.Instance; }, "Read/Write");
      rig.Mesh.IsReadable = true;
      string text = null;
      rig.Character.Failed.AddListener((who, why) => { text = why; });
      Host.Frame();
      rig.Character.Undo();
      Host.Frame();
      Expect.That(!string.IsNullOrEmpty(text), "a failed operation has a text");
      Expect.Throws<InvalidOperationException>(() => rig.Character.IsSoft = true, "before its first frame");
      Expect.Throws<ArgumentException>(() => rig.Character.Cut(Vector3.zero, Vector3.one, true, rig.Object.transform), "no bone of");
      UnityEngine.Object.Destroy(rig.Object);
      Rig soft = new Rig(CharacterSkinning.ByUnity, true);
      Expect.Throws<InvalidOperationException>(() => { Instance instance = soft.Character.Instance; }, "tissue needs");
      UnityEngine.Object.Destroy(soft.Object);
    }

    internal static void OneBladePerCharacter()
    {
      Rig one = new Rig(CharacterSkinning.BySunder, false), other = new Rig(CharacterSkinning.BySunder, false, one.Mesh);
      int torn = 0;
      string failure = "";
      foreach (Rig rig in new[] { one, other })
      {
        rig.Character.Torn.AddListener((who, info) => { ++torn; });
        rig.Character.Failed.AddListener((who, text) => { failure = text; });
      }
      Host.Frame();
      Blade first = new GameObject("first").AddComponent<Blade>(), second = new GameObject("second").AddComponent<Blade>();
      for (int i = 0; i <= 30; ++i)
      {
        foreach (Blade blade in new[] { first, second })
        {
          blade.EdgeTip = new Vector3(0, 0, 0.55f);
          blade.transform.localRotation = one.Object.transform.rotation;
          blade.transform.localPosition = one.Object.transform.TransformPoint(new Vector3(-0.4f + 0.025f * i, blade == first ? 0.4f : 0.6f, -0.3f));
        }
        Host.Frame();
        if (i == 15) Expect.That(first.MetCount == 2 && second.MetCount == 0, "the first blade tears both characters, which stand in one place");
        if (i == 20) first.enabled = false;  // ends its strokes; the second one begins
      }
      Expect.That(first.MetCount == 0 && second.MetCount == 2, "the second blade goes on");
      other.Character.enabled = false;
      Expect.Equal(second.MetCount, 1, "characters that it tears");
      Host.Frame();
      Expect.That(torn >= 4, "tears: " + torn);
      Expect.Equal(failure, "", "what failed");
      int undo, redo;
      one.Character.Instance.GetUndoCounts(out undo, out redo);
      Expect.That(undo >= 1, "strokes");
      ExpectBuffers(one);
      foreach (UnityEngine.Object made in new UnityEngine.Object[] { first.gameObject, second.gameObject, one.Object, other.Object }) UnityEngine.Object.Destroy(made);
    }

    static void MoveBlade(Blade blade, Rig rig, float x, float y)
    {
      blade.EdgeTip = new Vector3(0, 0, 0.55f);
      blade.transform.localRotation = rig.Object.transform.rotation;
      blade.transform.localPosition = rig.Object.transform.TransformPoint(new Vector3(x, y, -0.3f));
    }

    static BladePosition UpTheSide(int step)
    {
      BladePosition blade = new BladePosition();
      blade.Base = new Vector3d(0.01, 0.3 + 0.05 * step, -0.6);
      blade.Tip = new Vector3d(0.01, 0.3 + 0.05 * step, 0);
      return blade;
    }

    /// <summary>A stroke that a program opened by itself is the same with a blade that moves through the character meanwhile.</summary>
    internal static void BladesLeaveStrokesOfOthers()
    {
      Rig alone = new Rig(CharacterSkinning.BySunder, false);
      Host.Frame();
      alone.Character.Instance.BeginStroke(UpTheSide(0));
      for (int i = 1; i <= 20; ++i)
      {
        alone.Character.Instance.ExtendStroke(UpTheSide(i), 0.02);
        Host.Frame();
      }
      alone.Character.Instance.EndStroke();
      Host.Frame();
      ulong wanted = alone.Character.Instance.Digest;
      UnityEngine.Object.Destroy(alone.Object);

      Rig rig = new Rig(CharacterSkinning.BySunder, false);
      int refused = 0;
      rig.Character.Failed.AddListener((who, text) => { ++refused; });
      Host.Frame();
      Blade blade = new GameObject("blade").AddComponent<Blade>();
      rig.Character.Instance.BeginStroke(UpTheSide(0));
      for (int i = 1; i <= 20; ++i)
      {
        rig.Character.Instance.ExtendStroke(UpTheSide(i), 0.02);
        MoveBlade(blade, rig, -1.5f + 0.15f * i, 0.6f);
        Host.Frame();
      }
      rig.Character.Instance.EndStroke();
      Host.Frame();
      Expect.Equal(refused, 1, "strokes of the blade that were refused: one, and not one per frame");
      Expect.That(rig.Character.Instance.Digest == wanted && wanted != 0, "the stroke is that of a program without a blade");
      for (int i = 1; i <= 20; ++i)
      {
        MoveBlade(blade, rig, 1.5f - 0.15f * i, 0.6f);
        Host.Frame();
      }
      Expect.That(refused == 1 && rig.Character.Instance.Digest != wanted, "the blade tears when it comes back");
      UnityEngine.Object.Destroy(blade.gameObject);
      UnityEngine.Object.Destroy(rig.Object);
    }

    internal static void StrokesHaveOwners()
    {
      Rig rig = new Rig(CharacterSkinning.BySunder, false);
      string failure = "";
      rig.Character.Failed.AddListener((who, text) => { failure = text; });
      Host.Frame();
      object mine = new object(), others = new object();
      Expect.Throws<ArgumentNullException>(() => rig.Character.BeginStroke(null, UpTheSide(0)), "owner");
      Expect.That(!rig.Character.ExtendStroke(mine, UpTheSide(0), 0.02) && !rig.Character.EndStroke(mine), "no stroke was begun");
      Expect.That(rig.Character.BeginStroke(mine, UpTheSide(0)) && rig.Character.HasStroke, "a stroke");
      Expect.That(!rig.Character.BeginStroke(others, UpTheSide(0)), "a second stroke");
      Expect.That(rig.Character.ExtendStroke(mine, UpTheSide(1), 0.02) && !rig.Character.ExtendStroke(others, UpTheSide(5), 0.02), "its owner goes on");
      Blade blade = new GameObject("blade").AddComponent<Blade>();
      for (int i = 0; i <= 10; ++i)
      {
        MoveBlade(blade, rig, -0.1f + 0.02f * i, 0.6f);
        Host.Frame();
        Expect.Equal(blade.MetCount + failure, "0", "characters that the blade tears, and what failed");
      }
      Expect.That(!rig.Character.EndStroke(others) && rig.Character.EndStroke(mine) && !rig.Character.HasStroke, "its owner ends it");
      ulong torn = rig.Character.Instance.Digest;
      Expect.That(torn != 0, "torn");
      // Begun and ended within a frame.
      Expect.That(rig.Character.BeginStroke(others, UpTheSide(4)) && rig.Character.ExtendStroke(others, UpTheSide(8), 0.02) && rig.Character.EndStroke(others), "a short one");
      blade.enabled = false;
      Host.Frame();
      Host.Frame();
      Expect.That(!rig.Character.HasStroke && rig.Character.Instance.Digest != torn, "the short one tore and is ended");
      // Ended by itself where the character is disabled, also before the library has begun it.
      rig.Character.BeginStroke(mine, UpTheSide(0));
      rig.Character.enabled = false;
      Expect.That(!rig.Character.ExtendStroke(mine, UpTheSide(1), 0.02), "a disabled character has no stroke");
      rig.Character.enabled = true;
      Host.Frame();
      Host.Frame();
      Expect.That(!rig.Character.HasStroke && rig.Character.BeginStroke(others, UpTheSide(0)), "a stroke after that");
      Host.Frame();
      Expect.Equal(failure, "", "what failed");
      UnityEngine.Object.Destroy(blade.gameObject);
      UnityEngine.Object.Destroy(rig.Object);
    }

    /// <summary>Characters that are disabled, as in a pool, leave a scene that is destroyed; those of a new scene work.</summary>
    internal static void PooledCharactersLeave()
    {
      Rig pooled = new Rig(CharacterSkinning.BySunder, false), listed = new Rig(CharacterSkinning.ByUnity, false);
      Host.Frame();
      pooled.Character.enabled = false;
      UnityEngine.Object.Destroy(TearScene.Current.gameObject);
      Expect.That(pooled.Character.Instance == null && listed.Character.Instance == null, "no instance is left");
      Expect.That(pooled.Renderer.enabled && listed.Renderer.sharedMesh == listed.Mesh, "the renderers draw what they had");
      pooled.Character.enabled = true;
      Host.Frame();
      Expect.That(!pooled.Character.BeginStroke(pooled, UpTheSide(0)), "a stroke without an instance");
      Rig next = new Rig(CharacterSkinning.BySunder, false);
      Host.Frame();
      ExpectBuffers(next);
      // Also if a program disposed the scene, or destroyed the instance, by itself.
      Rig gone = new Rig(CharacterSkinning.BySunder, false);
      gone.Character.Instance.Destroy();
      UnityEngine.Object.Destroy(gone.Object);
      TearScene.Current.Scene.Dispose();
      foreach (Rig rig in new[] { pooled, listed, next }) UnityEngine.Object.Destroy(rig.Object);
      Expect.Equal(TearScene.Current.CharacterCount, 0, "characters");
      UnityEngine.Object.Destroy(TearScene.Current.gameObject);
    }

    internal static void FailedEntriesLeaveNothing()
    {
      Rig one = new Rig(CharacterSkinning.BySunder, false), other = new Rig(CharacterSkinning.BySunder, false, one.Mesh);
      CharacterAsset asset = one.Character.Instance.Asset;
      int objects = Host.Count;
      other.Bones[2].localPosition = new Vector3(float.NaN, 0, 0);
      Expect.Throws<SunderException>(() => { Instance instance = other.Character.Instance; }, "finite");
      Expect.That(TearScene.Current.Scene.InstanceCount == 1 && Host.Count == objects && other.Character.Mesh == null, "nothing is left of it");
      other.Bones[2].localPosition = new Vector3(0, 0.7f, 0);
      Host.Frame();
      ExpectBuffers(other);
      Expect.That(other.Character.Instance.Asset == asset, "the asset is shared");
      UnityEngine.Object.Destroy(one.Object);
      UnityEngine.Object.Destroy(other.Object);
      Expect.Throws<ObjectDisposedException>(() => asset.GetTriangles(0), "CharacterAsset");
    }

    /// <summary>What one listener throws, or one character cannot draw, stops no other.</summary>
    internal static void ListenersThatThrow()
    {
      Rig one = new Rig(CharacterSkinning.BySunder, false), other = new Rig(CharacterSkinning.BySunder, false, one.Mesh), broken = new Rig(CharacterSkinning.BySunder, false, one.Mesh);
      Host.Frame();
      bool heard = false;
      one.Character.Failed.AddListener((who, text) => { throw new InvalidOperationException("thrown by a listener"); });
      other.Character.Failed.AddListener((who, text) => { heard = true; });
      one.Character.Undo();
      other.Character.Undo();
      broken.Character.Mesh.IsBroken = true;
      Debug.Logged = "";
      foreach (Rig rig in new[] { one, broken }) rig.Bend(20);
      Pose(other, 20);
      ExpectBuffers(one);
      ExpectBuffers(other);
      Expect.That(heard && Debug.Logged.Contains("thrown by a listener"), "logged: " + Debug.Logged);
      Expect.That(!broken.Character.enabled && Debug.Logged.Contains("broken"), "one that cannot be drawn is disabled");
      foreach (Rig rig in new[] { one, other, broken }) UnityEngine.Object.Destroy(rig.Object);
    }

    /// <summary>Getters of Unity that copy arrays are not called per bone.</summary>
    internal static void ArraysAreReadOnce()
    {
      Rig rig = new Rig(CharacterSkinning.BySunder, false);
      rig.Renderer.Copies = rig.Mesh.Copies = 0;
      Host.Frame();
      Expect.That(rig.Renderer.Copies <= 5 && rig.Mesh.Copies <= 2, "copies of bones: " + rig.Renderer.Copies + ", of bind poses: " + rig.Mesh.Copies);
      UnityEngine.Object.Destroy(rig.Object);
    }

    internal static void SnapshotsComeBack()
    {
      foreach (CharacterSkinning skinning in new[] { CharacterSkinning.BySunder, CharacterSkinning.ByUnity })
      {
        Rig rig = new Rig(skinning, false);
        Host.Frame();
        Scene scene = TearScene.Current.Scene;
        CharacterAsset[] assets = { rig.Character.Instance.Asset };
        byte[] whole = scene.Save();
        rig.Character.Cut(rig.Object.transform.TransformPoint(new Vector3(0, 0.4f, 0)), rig.Object.transform.rotation * new Vector3(0, 1, 0));
        Pose(rig, 10);
        ulong digest = rig.Character.Instance.Digest;
        byte[] torn = scene.Save();
        scene.Restore(whole, assets);
        Pose(rig, 20);
        ExpectBuffers(rig);
        Expect.That(rig.Character.Instance.Digest != digest, "it is whole");
        scene.Restore(torn, assets);
        Pose(rig, 30);
        ExpectBuffers(rig);
        Expect.Equal(rig.Character.Instance.Digest, digest, "it is torn again");
        UnityEngine.Object.Destroy(rig.Object);
      }
    }

    internal static void AMissingBoneStopsOneCharacter()
    {
      Rig one = new Rig(CharacterSkinning.BySunder, false), other = new Rig(CharacterSkinning.BySunder, false, one.Mesh);
      Host.Frame();
      Debug.Logged = "";
      UnityEngine.Object.Destroy(one.Bones[2].gameObject);
      Pose(other, 10);
      ExpectBuffers(other);
      Expect.That(!one.Character.enabled && other.Character.enabled && Debug.Logged.Contains("destroyed"), "one is disabled: " + Debug.Logged);
      UnityEngine.Object.Destroy(one.Object);
      UnityEngine.Object.Destroy(other.Object);
    }

    /// <summary>The scripts of the package's sample: a drag tears, a severed limb falls.</summary>
    internal static void SampleWorks()
    {
      Rig rig = new Rig(CharacterSkinning.BySunder, false);
      Host.Frame();
      Camera.main = new GameObject("camera").AddComponent<Camera>();
      MouseScalpel scalpel = Camera.main.gameObject.AddComponent<MouseScalpel>();
      scalpel.Character = rig.Character;
      Input.IsPressed = true;
      for (int i = 0; i < 20; ++i)
      {
        Camera.main.transform.localPosition = rig.Object.transform.TransformPoint(new Vector3(-0.07f + 0.007f * i, 0.3f, -1));
        Camera.main.transform.localRotation = rig.Object.transform.rotation;
        Host.Frame();
      }
      Input.IsPressed = false;
      Host.Frame();
      Host.Frame();
      int torn = rig.Character.Instance.GetPosedMesh().VertexCount;
      Expect.That(torn > rig.Mesh.vertexCount, "the mouse tears");
      rig.Object.AddComponent<Severable>();
      Host.Frame();
      int objects = Host.Count;
      rig.Object.GetComponent<Severable>().Sever(rig.Bones[2]);
      for (int i = 0; i < 3; ++i) Host.Frame();
      Expect.Equal(Host.Count, objects + 1, "objects: a piece came off");
      ExpectBuffers(rig);
      UnityEngine.Object.Destroy(Camera.main.gameObject);
      UnityEngine.Object.Destroy(rig.Object);
    }

    /// <summary>A character with tissue that moves, a blade that tears it, and undo: only a frame that makes buffers larger allocates.</summary>
    internal static void FramesMakeNoGarbage()
    {
      Rig rig = new Rig(CharacterSkinning.BySunder, true);
      Blade blade = new GameObject("blade").AddComponent<Blade>();
      blade.EdgeTip = new Vector3(0, 0, 0.5f);
      int grown = 0, torn = 0;
      rig.Character.Torn.AddListener((who, info) => { ++torn; });
      Host.Frame();
      TearScene scene = TearScene.Current;
      UnityEngine.Mesh mesh = rig.Character.Mesh;
      Transform hand = blade.gameObject.transform;
      long uploaded = 0;
      System.Diagnostics.Stopwatch watch = new System.Diagnostics.Stopwatch();
      for (int i = 0; i < 1200; ++i)
      {
        if (i == 200)
        {
          uploaded = mesh.Uploaded;
          grown = torn = 0;
          watch.Start();
        }
        int vertices = mesh.vertexCount, indices = mesh.IndexCount;
        long allocated = GC.GetAllocatedBytesForCurrentThread();
        rig.Bones[2].localRotation = new Quaternion(0, 0, 0.1f * (float)Math.Sin(0.05 * i), 1);
        hand.localPosition = rig.Object.transform.TransformPoint(new Vector3(-0.7f + 1.4f * (i % 50) / 49f, 0.55f + 0.001f * (i % 20), -0.3f));
        hand.localRotation = rig.Object.transform.rotation;
        blade.Move(1f / 60);
        if (i % 50 == 49) rig.Character.Undo();
        scene.Step(1f / 60);
        allocated = GC.GetAllocatedBytesForCurrentThread() - allocated;
        if (mesh.vertexCount != vertices || mesh.IndexCount != indices) ++grown;
        else if (i >= 200) Expect.Equal(allocated, 0L, "bytes allocated in frame " + i);
      }
      Expect.That(torn > 100 && grown < 10, "frames that tore: " + torn + ", and that made buffers larger: " + grown);
      Console.WriteLine("1,000 frames of the Unity layer: 0 bytes, but for " + grown + " frames that made buffers larger; " + torn + " frames tore; "
        + (mesh.Uploaded - uploaded) / 1000 + " bytes uploaded and " + (watch.Elapsed.TotalMilliseconds / 1000).ToString("0.000") + " ms a frame");
      ExpectBuffers(rig);
      UnityEngine.Object.Destroy(blade.gameObject);
      UnityEngine.Object.Destroy(rig.Object);
    }

    static int Main()
    {
      int failed = 0;
      foreach (Action test in new Action[] { PosedPositionsAgree, BladeTears, OneSidedTear, UnitySkinsAsTheLibrary, ManyTearsGrowTheBuffers, PiecesFall,
        CharactersShareAssets, FaultsHaveTexts, OneBladePerCharacter, BladesLeaveStrokesOfOthers, StrokesHaveOwners,
        PooledCharactersLeave, FailedEntriesLeaveNothing, ListenersThatThrow, ArraysAreReadOnce, SnapshotsComeBack, AMissingBoneStopsOneCharacter, SampleWorks, FramesMakeNoGarbage })
      {
        try
        {
          test();
          Console.WriteLine("ok      " + test.Method.Name);
        }
        catch (Exception exception)
        {
          ++failed;
          Console.WriteLine("FAILED  " + test.Method.Name + ": " + exception);
        }
      }
      return failed == 0 ? 0 : 1;
    }
  }
}
