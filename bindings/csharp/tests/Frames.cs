using System;
using System.Diagnostics;

namespace Sunder.Tests
{
  /// <summary>A frame makes nothing that the garbage collector would have to take.</summary>
  static unsafe class Frames
  {
    static float[] positions = new float[1 << 18];
    static uint[] triangles = new uint[1 << 18];

    static void Upload(PosedMesh mesh)
    {
      VertexRangeView dirty = mesh.DirtyVertices;
      FloatView from = mesh.Positions;
      for (int i = 0; i < dirty.Count; ++i)
        for (uint v = 3 * dirty[i].First; v < 3 * (dirty[i].First + dirty[i].Count); ++v) positions[v] = from[(int)v];
      if (mesh.InitialTriangles.Count > 0) mesh.InitialTriangles.CopyTo(triangles);
      TriangleWriteView writes = mesh.TriangleWrites;
      for (int i = 0; i < writes.Count; ++i)
      {
        triangles[3 * writes[i].Place] = writes[i].Vertices.A;
        triangles[3 * writes[i].Place + 1] = writes[i].Vertices.B;
        triangles[3 * writes[i].Place + 2] = writes[i].Vertices.C;
      }
    }

    /// <summary>All that a game does in a frame: a pose of its own, a stroke that goes on, holds, queries, results, uploads.</summary>
    sealed class Game
    {
      readonly Scene scene;
      readonly Instance who;
      readonly double[] matrices;
      readonly SurfaceContact[] contacts = new SurfaceContact[16];
      Hold hold;
      Hold? held;
      ulong seen;
      int hits;
      internal int Torn, Vertices;

      internal Game(Character character)
      {
        SceneOptions one = SceneOptions.Default;
        one.Threads = 1;
        scene = new Scene(one);
        AssetOptions options = AssetOptions.Default;
        options.IsSoft = true;
        options.Tension = 5;
        who = scene.Spawn(new CharacterAsset(character, options, new[] { Tissue.Find("skin") }));
        who.PrepareToTear();
        matrices = new double[12 * character.BoneCount];
        character.ComputeMatrices(null, matrices);
        scene.Update(0);
        hold = who.HoldPoint(who.GetPoint(0, 5).Value, new Vector3d(0, 0, 0.5));
        held = hold;
      }

      internal void Frame(int frame)
      {
        matrices[12 * 2 + 9] += 1e-4 * Math.Sin(0.1 * frame);
        who.SetMatrices(matrices);
        BladePosition blade;
        blade.Base = new Vector3d(-0.2 + 0.4 * (frame % 40 / 40.0), 0.4 + 1e-3 * frame, 2);
        blade.Tip = new Vector3d(blade.Base.X, blade.Base.Y, 0);
        Command command = frame % 40 == 0 ? who.BeginStroke(blade) : frame % 40 == 39 ? who.EndStroke() : who.ExtendStroke(blade, 1.0 / 90);
        held.Value.Move(new Vector3d(0, 0, 0.5 + 0.01 * Math.Sin(0.05 * frame)));
        scene.Update(1.0 / 90);
        OperationResult result;
        if (command.TryGetResult(out result) && result.Runs > 0) ++Torn;
        for (int i = 0; i < scene.ResultCount; ++i) scene.GetResult(i).Check();
        SurfaceContact contact;
        if (who.CastRay(blade.Base, new Vector3d(0, 0, -1), 10, out contact)) ++hits;
        hits += who.FindBladeContacts(blade, contacts);
        PosedMesh mesh = who.GetPosedMesh(0, seen);
        Upload(mesh);
        seen = mesh.Epoch;
        Vertices = mesh.VertexCount;
        MeshView bind = who.GetMesh();
        Expect.That(bind.Positions.Count == 3 * mesh.VertexCount && bind.FirstInfluence.Count == mesh.VertexCount + 1, "vertices");
        Expect.That(scene.Drawn.Count <= 1 && scene.Stats.Frame > 0 && who.TissueInfo.ParticleCount > 0, "figures");
        if (frame % 40 == 39) who.Undo();
      }
    }

    internal static void Run(Character character)
    {
      Game game = new Game(character);
      for (int frame = 0; frame < 80; ++frame) game.Frame(frame);  // compiles
      GC.Collect();
      Stopwatch watch = Stopwatch.StartNew();
      int collections = GC.CollectionCount(0);
      long allocated = GC.GetAllocatedBytesForCurrentThread();
      for (int frame = 80; frame < 1080; ++frame) game.Frame(frame);
      allocated = GC.GetAllocatedBytesForCurrentThread() - allocated;
      double milliseconds = watch.Elapsed.TotalMilliseconds;
      Expect.Equal(allocated, 0L, "bytes allocated in 1,000 frames");
      Expect.Equal(GC.CollectionCount(0) - collections, 0, "collections in 1,000 frames");
      Expect.That(game.Torn > 10, "strokes in the loop tear: " + game.Torn);
      Console.WriteLine("1,000 frames: 0 bytes, " + game.Torn + " frames tore, " + game.Vertices + " vertices, " + (milliseconds / 1000).ToString("0.000") + " ms a frame");
      // That the counter counts.
      allocated = GC.GetAllocatedBytesForCurrentThread();
      positions = new float[1 << 18];
      Expect.That(GC.GetAllocatedBytesForCurrentThread() - allocated >= 1 << 20, "the counter of allocated bytes counts");
    }
  }
}
