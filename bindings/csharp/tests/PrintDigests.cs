using System;
using System.IO;

namespace Sunder.Tests
{
  /// <summary>What tests/c/print_digests.c does, through this binding: it prints the same lines.</summary>
  static unsafe class PrintDigests
  {
    const ulong Start = 14695981039346656037ul;

    static ulong Hash(ulong hash, byte* bytes, long size)
    {
      for (long i = 0; i < size; ++i) hash = (hash ^ bytes[i]) * 1099511628211ul;
      return hash;
    }

    static ulong HashMeshes(Instance who)
    {
      ulong hash = Start;
      for (int m = 0; m < who.Asset.Character.MeshCount; ++m)
      {
        PosedMesh mesh = who.GetPosedMesh(m);
        hash = Hash(hash, (byte*)mesh.Positions.Pointer, 4L * mesh.Positions.Count);
        if (mesh.Normals.Count > 0) hash = Hash(hash, (byte*)mesh.Normals.Pointer, 4L * mesh.Normals.Count);
      }
      return hash;
    }

    /// <summary>A stroke with walls over 8 frames, from side to side through the middle of the model, twice, of which the second is
    /// undone; then tissue tears by force.</summary>
    static void GoOn(Scene scene, Instance who)
    {
      scene.Update(1.0 / 64);
      FloatView positions = who.GetPosedMesh().Positions;
      double[] low = { positions[0], positions[1], positions[2] }, high = { positions[0], positions[1], positions[2] };
      for (int i = 3; i < positions.Count; ++i)
      {
        low[i % 3] = Math.Min(low[i % 3], positions[i]);
        high[i % 3] = Math.Max(high[i % 3], positions[i]);
      }
      TearOptions options = TearOptions.Default;
      // The sizes are rounded to float, as those of C.
      float width = (float)(high[0] - low[0]), height = (float)(high[1] - low[1]), depth = (float)(high[2] - low[2]);
      options.Width = 0.01 * width;
      options.WallDepth = 0.02 * width;
      for (int frame = 0; frame < 16; ++frame)
      {
        double along = frame % 8 / 7.0;
        BladePosition blade;
        blade.Base.X = low[0] + (0.2 + 0.6 * along) * width;
        blade.Base.Y = 0.5 * (float)(low[1] + high[1]) + (frame / 8 - 0.5) * 0.3 * height;
        blade.Base.Z = (float)(high[2] + depth);
        blade.Tip = new Vector3d(blade.Base.X, blade.Base.Y, 0.5 * (float)(low[2] + high[2]));
        if (frame % 8 == 0) who.BeginStroke(blade, options);
        else who.ExtendStroke(blade, 1.0 / 64);
        if (frame % 8 == 7) who.EndStroke();
        scene.Update(1.0 / 64);
      }
      who.Undo();
      for (int frame = 0; frame < 8; ++frame)
      {
        scene.Update(1.0 / 64);
        who.TearOverstretched();
      }
      scene.Update(1.0 / 64);
    }

    static void Print(string folder, int number, TextWriter to)
    {
      SceneOptions one = SceneOptions.Default;
      one.Threads = 1;  // scenes of the C program have more: the bits are the same
      TissueMaterial weak = Tissue.Find("skin");
      weak.Strength = 1.2;
      AssetOptions options = AssetOptions.Default;
      options.IsSoft = true;
      options.Tension = 2.0;
      options.Gravity.Y = -9.81;
      using (Character character = Character.FromGlb(File.ReadAllBytes(Path.Combine(folder, number + ".glb"))))
      using (CharacterAsset asset = new CharacterAsset(character, options, new[] { weak }))
      using (Scene scene = new Scene(one), again = new Scene(one))
      {
        Instance who = scene.Spawn(asset);
        if (character.ClipCount > 0) who.Play(0);
        scene.Update(0.25);
        Status status = Status.Ok;
        uint applied = 0;
        try
        {
          applied = (uint)who.ApplyLog(File.ReadAllText(Path.Combine(folder, number + ".json")));
        }
        catch (SunderException exception)
        {
          status = exception.Code;
          applied = exception.Index ?? 0;
        }
        scene.Update(1.0 / 64);
        to.Write(number + " " + (int)status + " " + applied + " " + who.Digest.ToString("x16") + " " + HashMeshes(who).ToString("x16"));
        for (int frame = 0; frame < 100; ++frame) scene.Update(1.0 / 64);
        byte[] snapshot = scene.Save();
        to.Write(" " + HashMeshes(who).ToString("x16"));
        fixed (byte* bytes = snapshot) to.Write(" " + Hash(Start, bytes, snapshot.Length).ToString("x16"));
        again.Restore(snapshot, new[] { asset });
        Instance restored = again.Adopt(who.Id, asset);
        GoOn(again, restored);
        to.Write(" " + (restored.Digest ^ HashMeshes(restored) * 0x9E3779B97F4A7C15ul).ToString("x16") + "\n");
      }
    }

    internal static void Run(string folder, int count, string file)
    {
      using (StreamWriter to = new StreamWriter(file))
        for (int i = 0; i < count; ++i) Print(folder, i, to);
    }
  }
}
