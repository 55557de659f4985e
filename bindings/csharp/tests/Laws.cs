using System;
using System.Collections.Generic;
using System.IO;
using System.Threading;

namespace Sunder.Tests
{
  /// <summary>The layer hands on what it is given, and gives what the library has: compared by the laws of tears.</summary>
  static unsafe class Laws
  {
    internal static BladePosition[] Stroke(double y)
    {
      BladePosition[] blades = new BladePosition[5];
      for (int i = 0; i < blades.Length; ++i)
      {
        blades[i].Base = new Vector3d(-0.3 + 0.15 * i, y, 2);
        blades[i].Tip = new Vector3d(blades[i].Base.X, y, 0);
      }
      return blades;
    }

    internal static void Operations(Character character)
    {
      Scene scene = new Scene();
      Instance instance = scene.Spawn(new CharacterAsset(character));
      Expect.Equal(instance.Digest, 0ul, "nothing was torn");
      TearOptions options = TearOptions.Default;
      options.Width = 0.02;
      options.WallDepth = 0.05;
      Command command = instance.Tear(Stroke(1.0), options);
      scene.Update(1.0 / 60);
      OperationResult result = command.Result;
      Expect.That(result.Runs > 0 && result.FacesCrossed > 0 && result.VerticesAdded > 0 && result.Length > 0 && result.AreaRemoved > 0, "a tear");
      Expect.Equal(instance.GetMesh().VertexCount, character.GetMesh(0).VertexCount + result.VerticesAdded, "vertices");
      ulong torn = instance.Digest;
      instance.Undo();
      scene.Update(0);
      int undo, redo;
      instance.GetUndoCounts(out undo, out redo);
      Expect.Equal(undo + " " + redo, "0 1", "operations to undo and redo");
      instance.Redo();
      scene.Update(0);
      Expect.Equal(instance.Digest, torn, "redone");
      Bore bore = Bore.Default;
      bore.Origin = new Vector3d(0, 1.5, 2);
      bore.Direction = new Vector3d(0, 0, -1);
      bore.Radius = 0.1;
      bore.Depth = 4;
      command = instance.Drill(bore);
      scene.Update(0);
      Expect.That(command.Result.TrianglesRetired > 0, "a bore");
      PlaneCut cut = PlaneCut.Default;
      cut.Point = new Vector3d(0, 0.5, 0);
      cut.Normal = new Vector3d(0, 1, 0);
      cut.HasCaps = true;
      command = instance.Cut(cut, null, new[] { new Vector3d(0, 0.5, 0) });
      scene.Update(0);
      Expect.That(command.Result.Caps > 0 && command.Result.SeparatedPieces > 0, "a cut");
      string log = instance.Log;
      Instance again = scene.Spawn(instance.Asset);
      Expect.Equal(again.ApplyLog(log), 3, "operations of the log");
      Expect.Equal(again.Digest, instance.Digest, "replayed");
      Instance whole = scene.Spawn(instance.Asset);
      whole.Cut(cut, null, new[] { new Vector3d(0, 0.5, 0) });
      scene.Update(0);
      ulong severed = whole.Digest;
      ulong unsewn = whole.Digest;
      global::Sunder.Suture suture = global::Sunder.Suture.Default;
      suture.Spacing = 0.1;
      command = whole.Suture(suture);
      scene.Update(0);
      Expect.That(command.Result.Runs > 0 && whole.Digest != unsewn, "a suture");
      Expect.That(whole.Threads.Length >= command.Result.Runs && whole.Threads[0].LeftVertex != whole.Threads[0].RightVertex, "threads");
      whole.Undo();
      scene.Update(0);
      Expect.Equal(whole.Digest, unsewn, "undone");
      command = whole.Weld(new[] { new Vector3d(0, 0.5, 0) });
      scene.Update(0);
      Expect.That(command.Result.Runs > 0 && whole.Digest != severed, "a weld");
      Expect.Throws<ArgumentException>(() => whole.Weld(new Vector3d[0]), "is empty");
      Detachment detachment = Detachment.Default;
      detachment.Point = new Vector3d(0, 3, 0);
      command = instance.Detach(detachment);
      scene.Update(0);
      Expect.That(command.Result.HasPiece, "a piece");
      CheckPiece(command.Result.TakePiece());
      using (Character saved = Character.FromGlb(instance.ToGlb())) Expect.That(saved.GetMesh(0).TriangleCount > 0, "a file");
      CheckOrigins(again, character);
    }

    static void CheckPiece(Piece piece)
    {
      PieceInfo info = piece.Info;
      Expect.That(info.Mass > 0 && info.Volume > 0 && info.Inertia[1, 1] > 0, "mass and inertia");
      Expect.Throws<ArgumentOutOfRangeException>(() => info.Inertia[3, 0].ToString(), "3 elements");
      int torn;
      UIntView vertices = piece.GetTornVertices(0, out torn);
      Expect.That(torn == 0 && vertices.Count > 0, "vertices of the torn mesh");
      ConvexHull[] hulls = piece.GetHulls(4, 32);
      Expect.That(hulls.Length > 0 && hulls[0].Points.Length >= 12 && hulls[0].Triangles.Length >= 12, "hulls");
      using (Character character = piece.ToCharacter()) Expect.Equal(character.GetMesh(0).VertexCount, vertices.Count, "vertices of the piece");
      piece.Dispose();
      Expect.Throws<ObjectDisposedException>(() => vertices[0].ToString(), "Piece");
    }

    static void CheckOrigins(Instance torn, Character character)
    {
      int source = character.GetMesh(0).VertexCount;
      VertexOrigin[] origins = torn.GetVertexOrigins(0, source);
      MeshView mesh = torn.GetMesh();
      FloatView positions = mesh.Positions;
      UIntView triangles = character.GetMesh(0).Triangles;
      Expect.Equal(origins.Length, mesh.VertexCount - source, "origins");
      Expect.Equal(torn.GetTriangleOrigins(0).Length, mesh.TriangleCount, "triangles");
      int onTriangles = 0;
      for (int v = 0; v < origins.Length; ++v)
      {
        if (origins[v].Triangle == Constants.None) continue;
        double x = 0, sum = 0;
        double[] at = { origins[v].Barycentric.X, origins[v].Barycentric.Y, origins[v].Barycentric.Z };
        for (int i = 0; i < 3; ++i)
        {
          x += at[i] * positions[3 * (int)triangles[3 * (int)origins[v].Triangle + i]];
          sum += at[i];
        }
        Expect.Near(sum, 1, 1e-12, "barycentric coordinates of vertex " + v);
        Expect.Near(positions[3 * (source + v)], x, 1e-5, "position of vertex " + v);
        ++onTriangles;
      }
      Expect.That(onTriangles > 0, "vertices that come from triangles were compared");
      FloatView weights = default(FloatView);
      Expect.Equal(weights.Count, 0, "an empty view");
      UIntView first = mesh.FirstInfluence;
      InfluenceView influences = mesh.Influences;
      for (int v = 0; v < mesh.VertexCount; ++v)
      {
        double sum = 0;
        for (uint i = first[v]; i < first[v + 1]; ++i) sum += influences[(int)i].Weight;
        Expect.Near(sum, 1, 1e-6, "weights of vertex " + v);
      }
    }

    /// <summary>A copy of a character by its arrays tears like the character.</summary>
    internal static void Arrays(Character character)
    {
      CharacterArrays arrays = new CharacterArrays { Name = character.Name, Bones = BonesOf(character), Skins = SkinsOf(character) };
      arrays.Meshes = new MeshArrays[character.MeshCount];
      for (int i = 0; i < arrays.Meshes.Length; ++i) arrays.Meshes[i] = Copy(character.GetMesh(i));
      arrays.RestMorphWeights = character.RestMorphWeights.ToArray();
      using (Character copy = Character.FromArrays(arrays))
        Expect.Equal(TornDigest(copy), TornDigest(character), "digest of a copy");
    }

    static MeshArrays Copy(MeshView mesh)
    {
      MeshArrays copy = new MeshArrays {
        Name = mesh.Name, Skin = mesh.Skin, Positions = mesh.Positions.ToArray(), FirstInfluence = mesh.FirstInfluence.ToArray(),
        Influences = mesh.Influences.ToArray(), Triangles = mesh.Triangles.ToArray(), TriangleSubmesh = mesh.TriangleSubmesh.ToArray() };
      if (mesh.Normals.Count > 0) copy.Normals = mesh.Normals.ToArray();
      if (mesh.Tangents.Count > 0) copy.Tangents = mesh.Tangents.ToArray();
      copy.UvSets = new float[mesh.UvSetCount][];
      for (int i = 0; i < copy.UvSets.Length; ++i) copy.UvSets[i] = mesh.UvSet(i).ToArray();
      copy.ColorSets = new float[mesh.ColorSetCount][];
      for (int i = 0; i < copy.ColorSets.Length; ++i) copy.ColorSets[i] = mesh.ColorSet(i).ToArray();
      copy.Attributes = new AttributeArrays[mesh.AttributeCount];
      for (int i = 0; i < copy.Attributes.Length; ++i)
        copy.Attributes[i] = new AttributeArrays { Name = mesh.AttributeName(i), Values = mesh.AttributeValues(i).ToArray(), Components = mesh.AttributeWidth(i) };
      copy.MorphTargets = new MorphTargetArrays[mesh.MorphTargetCount];
      for (int i = 0; i < copy.MorphTargets.Length; ++i)
        copy.MorphTargets[i] = new MorphTargetArrays { Name = mesh.MorphTargetName(i), PositionDeltas = OrNull(mesh.PositionDeltas(i)),
          NormalDeltas = OrNull(mesh.NormalDeltas(i)), TangentDeltas = OrNull(mesh.TangentDeltas(i)) };
      copy.Submeshes = new SubmeshArrays[mesh.SubmeshCount];
      for (int i = 0; i < copy.Submeshes.Length; ++i)
        copy.Submeshes[i] = new SubmeshArrays { Name = mesh.SubmeshName(i), Material = mesh.SubmeshMaterial(i) };
      return copy;
    }

    static float[] OrNull(FloatView view) { return view.Count > 0 ? view.ToArray() : null; }

    static ulong TornDigest(Character character)
    {
      using (Scene scene = new Scene())
      {
        Instance instance = scene.Spawn(new CharacterAsset(character));
        PlaneCut cut = PlaneCut.Default;
        FloatView positions = character.GetMesh(0).Positions;
        cut.Point = new Vector3d(positions[0], positions[1] + 0.01, positions[2]);
        cut.Normal = new Vector3d(0.1, 1, 0.2);
        instance.Cut(cut);
        scene.Update(0);
        return instance.Digest;
      }
    }

    /// <summary>How far the most displaced vertex is from where the bones have it, after a while under tension.</summary>
    static double Gape(Character character, AuthoredTissue authored)
    {
      AssetOptions options = AssetOptions.Default;
      options.IsSoft = true;
      options.Tension = 2;
      TissueMaterial skin = Tissue.Find("jelly");
      using (Scene scene = new Scene())
      using (CharacterAsset asset = new CharacterAsset(character, options, new[] { skin }, null, authored))
      {
        Instance instance = scene.Spawn(asset);
        instance.Tear(Stroke(1.0));
        for (int i = 0; i < 60; ++i) scene.Update(1.0 / 60);
        FloatView posed = instance.GetPosedMesh().Positions;
        float[] moved = posed.ToArray(), rest = instance.GetMesh().Positions.ToArray();
        double most = 0;
        for (int i = 0; i < rest.Length; ++i) most = Math.Max(most, Math.Abs(moved[i] - rest[i]));
        return most;
      }
    }

    internal static void Authored(Character character)
    {
      float[] values = new float[character.GetMesh(0).VertexCount];
      Func<TissueFactor, float, AuthoredTissue> even = (factor, value) => {
        for (int i = 0; i < values.Length; ++i) values[i] = value;
        return new AuthoredTissue { Fields = new[] { new FactorField { Factor = factor, Values = (float[])values.Clone() } } };
      };
      double plain = Gape(character, null);
      Expect.That(plain > 0.001, "a wound gapes: " + plain);
      foreach (TissueFactor factor in Enum.GetValues(typeof(TissueFactor)))
        Expect.Equal(Gape(character, even(factor, 1)), plain, "factors of 1 change no bit: " + factor);
      Expect.Equal(Gape(character, even(TissueFactor.Tension, 0)), 0.0, "no tension, no gap");
      Expect.That(Gape(character, even(TissueFactor.Stiffness, 4)) < 0.5 * plain, "stiff tissue gapes less");

      Expect.Fails(() => Gape(character, even(TissueFactor.Strength, 0)), Status.InvalidArgument);
      AuthoredTissue wrong = even(TissueFactor.Strength, 2);
      wrong.Fields[0].Values = new float[3];
      Expect.Fails(() => Gape(character, wrong), Status.SizeMismatch);
      wrong.Fields[0].Values = new float[0];
      Expect.Throws<ArgumentException>(() => Gape(character, wrong), "Fields[0].Values is empty");
      wrong.Fields[0].Values = values;
      wrong.Fields[0].Mesh = 9;
      Expect.Fails(() => Gape(character, wrong), Status.IndexOutOfRange);
      wrong.Fields[0] = null;
      Expect.Throws<ArgumentNullException>(() => Gape(character, wrong), "Fields[0]");

      SurfacePlace first = new SurfacePlace { Triangle = 0, Barycentric = new Vector3d(1, 0, 0) }, second = new SurfacePlace { Triangle = 0, Barycentric = new Vector3d(0, 0.5, 0.5) };
      PerforatedLine line = new PerforatedLine { Places = new[] { first, second }, Strength = 0.3 };
      AuthoredTissue holes = new AuthoredTissue { Perforations = new[] { line } };
      Expect.Equal(Gape(character, holes), plain, "a perforation moves nothing");
      line.Places = new[] { first };
      Expect.Fails(() => Gape(character, holes), Status.InvalidArgument);
      line.Places = new SurfacePlace[0];
      Expect.Fails(() => Gape(character, holes), Status.InvalidArgument);
      line.Places = new[] { first, second };
      line.Strength = 2;
      Expect.Fails(() => Gape(character, holes), Status.InvalidArgument);
      line.Places = null;
      Expect.Throws<ArgumentNullException>(() => Gape(character, holes), "Perforations[0]");

      using (Character painted = character.WithAttribute(0, "_TENSION", values))
      using (Character read = Character.FromGlb(painted.ToGlb()))
      {
        MeshView mesh = read.GetMesh(0);
        int found = -1;
        for (int i = 0; i < mesh.AttributeCount; ++i) if (mesh.AttributeName(i) == "_TENSION") found = i;
        Expect.That(found >= 0, "the file has the attribute");
        Expect.Equal(mesh.AttributeValues(found).ToArray()[5], values[5], "its values");
      }
      Expect.Fails(() => character.WithAttribute(0, "TENSION", values), Status.InvalidArgument);
      Expect.Fails(() => character.WithAttribute(0, "_TENSION", new float[3]), Status.SizeMismatch);
    }

    internal static void Tissues(Character character)
    {
      AssetOptions options = AssetOptions.Default;
      options.IsSoft = true;
      TissueMaterial jelly = Tissue.Find("jelly");
      jelly.Strength = jelly.Toughness = 0;
      using (Scene scene = new Scene())
      {
        Instance instance = scene.Spawn(new CharacterAsset(character, options, new[] { jelly }));
        instance.PrepareToTear();
        instance.BeginWoundMask();
        scene.Update(0.01);
        Hold hold = instance.HoldPoint(instance.GetPoint(0, 3).Value, new Vector3d(0, 0, 3));
        for (int i = 0; i < 10; ++i) scene.Update(0.01);
        Expect.That(instance.TissueInfo.IsAwake && instance.TissueInfo.ParticleCount > 0, "tissue moves");
        hold.Release();
        instance.SetColliders(new TissueCollider { Shape = ColliderShape.Sphere, Size = new Vector3d(0.2, 0, 0), Rotation = Vector4d.Identity });
        instance.MoveCollider(0, new Vector3d(0, 1, 0.5), Vector4d.Identity);
        instance.SetGravity(new Vector3d(0, -9.81, 0));
        instance.SetTension(3);
        instance.Push(instance.GetPoint(0, 3).Value, new Vector3d(0, 0, 0.1));
        instance.Tear(Stroke(1.0));
        scene.Update(0.01);
        Expect.That(!instance.TearOverstretched().HasTorn, "this jelly does not tear by force");
        scene.Update(0.01);
        WoundMask mask = instance.GetWoundMask();
        Expect.That(mask.ChangedWidth > 0 && mask.Distances.Count == mask.Width * mask.Height, "wounds in the texture");
        float[] ages = instance.GetWoundChannel(WoundChannel.Age), stretches = instance.GetWoundChannel(WoundChannel.Stretch);
        Expect.Equal(ages.Length, mask.Distances.Count, "an age per texel");
        Expect.That(Array.Exists(ages, age => age == 0) && Array.TrueForAll(ages, age => age == 0 || age == -1), "one wound, of the newest operation");
        Expect.That(Array.TrueForAll(stretches, stretch => stretch > 0), "stretches");
        BloodFlowOptions running = BloodFlowOptions.Default;
        running.Length = 0.5;
        float[] blood = instance.FlowBlood(0, running);
        Expect.That(blood.Length == ages.Length && Array.Exists(blood, one => one > 0), "blood runs");
        Expect.That(Array.TrueForAll(blood, one => one >= 0 && one <= 1), "shares of blood");
        running.Width = -1;
        Expect.Fails(() => instance.FlowBlood(0, running), Status.InvalidArgument);
        SurfaceContact contact;
        Expect.That(instance.FindNearest(new Vector3d(0, 1, 2), 10, out contact) && contact.Distance > 0, "the nearest place");
        Expect.That(!instance.CastRay(new Vector3d(0, 100, 0), new Vector3d(0, 1, 0), 1, out contact), "a ray that misses");
        using (ValidationReport report = instance.Validate())
        {
          FloatView bounds;
          Expect.Equal(report.GetDeviations(out bounds).Count, (int)report.Info.VertexCount, "deviations");
          Expect.That(report.Info.ErrorCount == 0 && report.GetFindings().Length == report.Info.WarningCount + report.Info.NoteCount, "findings");
        }
        Expect.That(Tissue.TensionForGap(Tissue.Find("skin"), 0.1, 0.01) > 0, "tension");
        CuttingResistance skin = CuttingResistance.Default;
        skin.Toughness = 2000;
        skin.Thickness = 0.004;
        skin.Greatest = 10;
        Expect.That(Tissue.BladeForce(skin, 0.01, 0.01, new Vector3d(0, 0.01, 0)).Y < 0, "force");
      }
    }

    /// <summary>A tube without weights of its own gets those of the tube.</summary>
    internal static void Transfers(Character tube)
    {
      MeshArrays mesh = Copy(tube.GetMesh(0));
      for (int v = 0; v + 1 < mesh.FirstInfluence.Length; ++v) mesh.FirstInfluence[v + 1] = (uint)v + 1;
      mesh.Influences = new Influence[mesh.Positions.Length / 3];
      for (int v = 0; v < mesh.Influences.Length; ++v) mesh.Influences[v].Weight = 1;
      bool[] locked = new bool[mesh.Influences.Length];
      locked[locked.Length - 1] = true;
      using (Character bare = Character.FromArrays(new CharacterArrays { Bones = BonesOf(tube), Skins = SkinsOf(tube), Meshes = new[] { mesh } }))
      using (SkinTransfer made = SkinTransfer.Make(tube, bare, null, new Dictionary<string, string> { { "bone0", "bone0" } }, null, locked))
      {
        Expect.That(made.Info.Coincident > 0 && made.Info.Locked == 1, "vertices");
        Expect.Equal(made.Outcomes[locked.Length - 1], TransferOutcome.Locked, "outcome of the locked vertex");
        int others = 0;
        for (int v = 0; v < locked.Length; ++v)
          if (Math.Abs(FirstBoneWeight(made.Character, v) - FirstBoneWeight(tube, v)) > 1e-6) ++others;
        // The locked one, and the vertex of the same place beyond the seam.
        Expect.That(others <= 2 && FirstBoneWeight(made.Character, locked.Length - 1) == 1, "vertices with other weights: " + others);
        Expect.Throws<ArgumentException>(() => SkinTransfer.Make(tube, bare, null, null, null, new bool[3]), "locked has 3");
        Expect.Fails(() => SkinTransfer.Make(tube, bare, null, null, new[] { "no such bone" }), Status.NotFound, "no such bone");
        Expect.Throws<ArgumentException>(() => SkinTransfer.Make(tube, bare, null, null, new string[0]), "bones is empty");
      }
    }

    static double FirstBoneWeight(Character character, int vertex)
    {
      MeshView mesh = character.GetMesh(0);
      double weight = 0;
      for (uint i = mesh.FirstInfluence[vertex]; i < mesh.FirstInfluence[vertex + 1]; ++i)
        if (mesh.Influences[(int)i].Slot == 0) weight += mesh.Influences[(int)i].Weight;
      return weight;
    }

    static BoneArrays[] BonesOf(Character character)
    {
      BoneArrays[] bones = new BoneArrays[character.BoneCount];
      for (int i = 0; i < bones.Length; ++i)
      {
        Bone bone = character.GetBone(i);
        bones[i] = new BoneArrays { Name = bone.Name, Parent = bone.Parent, Rest = bone.Rest };
      }
      return bones;
    }

    static SkinArrays[] SkinsOf(Character character)
    {
      SkinArrays[] skins = new SkinArrays[character.SkinCount];
      for (int i = 0; i < skins.Length; ++i)
        skins[i] = new SkinArrays { Bones = character.GetSkinBones(i).ToArray(), BoneFromBind = character.GetBoneFromBind(i).ToArray() };
      return skins;
    }

    /// <summary>A clip of arrays plays, also after a file.</summary>
    internal static void Clips(Character tube)
    {
      ChannelArrays up = new ChannelArrays { Target = ChannelTarget.Translation, Index = 1, Times = new float[] { 0, 2 }, Values = new float[] { 0, 1, 0, 0, 3, 0 } };
      ChannelArrays smooth = new ChannelArrays { Target = ChannelTarget.Scale, Index = 0, Interpolation = Interpolation.Cubic, Times = new float[] { 0, 2 },
        Values = new float[] { 0, 0, 0, 1, 1, 1, 0, 0, 0, 0, 0, 0, 2, 2, 2, 0, 0, 0 } };
      CharacterArrays arrays = new CharacterArrays { Bones = BonesOf(tube), Skins = SkinsOf(tube), Meshes = new[] { Copy(tube.GetMesh(0)) },
        Clips = new[] { new ClipArrays { Name = "grow", Duration = 2, Channels = new[] { up, smooth } } } };
      using (Character made = Character.FromArrays(arrays))
      using (Character read = Character.FromGlb(made.ToGlb()))
        foreach (Character character in new[] { made, read })
        {
          Expect.Equal(character.FindClip("grow") + " " + character.GetClipName(0) + " " + character.GetClipDuration(0), "0 grow 2", "the clip");
          BoneTransform[] pose = new BoneTransform[character.BoneCount];
          character.SampleClip(0, 1, pose);
          Expect.Near(pose[character.FindBone("bone1")].Translation.Y, 2, 1e-6, "half way");
          Expect.Near(pose[character.FindBone("bone0")].Scale.X, 1.5, 1e-6, "half way along a cubic");
          double[] matrices = new double[12 * character.BoneCount];
          character.ComputeMatrices(pose, matrices);
          Instance instance = new Scene().Spawn(new CharacterAsset(character));
          LayerOptions options = LayerOptions.Default;
          options.Time = 1;
          options.Speed = 0;
          Layer layer = instance.Play("grow", options);
          instance.Scene.Update(0);
          for (int i = 0; i < matrices.Length; ++i) Expect.Near(instance.Matrices[i], matrices[i], 1e-6, "matrix");
          Expect.Near(layer.State.Time, 1, 1e-6, "time of the layer");
          Expect.Throws<ArgumentException>(() => { up.Values = new float[5]; Character.FromArrays(arrays); }, "clip 0: channel 0: Values has 5");
          up.Values = new float[] { 0, 1, 0, 0, 3, 0 };
        }
    }

    /// <summary>Vertices are posed into memory of the program, with a stride.</summary>
    internal static void VertexTargets(Character tube)
    {
      using (Scene scene = new Scene())
      {
        CharacterAsset asset = new CharacterAsset(tube);
        Instance own = scene.Spawn(asset), other = scene.Spawn(asset);
        int count = tube.GetMesh(0).VertexCount;
        float[] buffer = new float[5 * count];
        fixed (float* first = buffer)
        {
          VertexTarget target = VertexTarget.Default;
          target.Positions = first;
          target.PositionStride = 20;
          target.VertexCount = (uint)count;
          own.SetVertexTarget(0, target);
          scene.Update(0);
          FloatView positions = other.GetPosedMesh().Positions;
          for (int i = 0; i < 3 * count; ++i) Expect.Equal(buffer[5 * (i / 3) + i % 3], positions[i], "number " + i);
          own.SetVertexTarget(0, VertexTarget.Default);
        }
      }
    }

    /// <summary>Objects that nobody refers to are destroyed by the collector, while others of theirs are used.</summary>
    internal static void Finalizers(byte[] glb)
    {
      Instance kept = null;
      for (int i = 0; i < 50; ++i)
      {
        kept = new Scene().Spawn(new CharacterAsset(Character.FromGlb(glb)));
        GC.Collect();
        GC.WaitForPendingFinalizers();
        kept.Tear(Stroke(1.0));
        kept.Scene.Update(0.01);
        Expect.That(kept.Digest != 0, "torn");
      }
    }

    /// <summary>Scenes in threads of their own; operations that are submitted from another thread.</summary>
    internal static void Threads(Character character)
    {
      CharacterAsset asset = new CharacterAsset(character);
      ulong[] digests = new ulong[4];
      List<Thread> threads = new List<Thread>();
      for (int i = 0; i < digests.Length; ++i)
      {
        int number = i;
        threads.Add(new Thread(() => {
          using (Scene scene = new Scene())
          {
            Instance instance = scene.Spawn(asset);
            Thread other = new Thread(() => instance.Tear(Stroke(1.0)));
            other.Start();
            other.Join();
            scene.Update(0.01);
            digests[number] = instance.Digest;
          }
        }));
      }
      foreach (Thread thread in threads) thread.Start();
      foreach (Thread thread in threads) thread.Join();
      foreach (ulong digest in digests) Expect.That(digest != 0 && digest == digests[0], "the digests of all threads");
    }
  }
}
