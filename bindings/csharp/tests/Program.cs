using System;
using System.Diagnostics;
using System.IO;

namespace Sunder.Tests
{
  static class Program
  {
    static int failed;

    static void Run(string name, Action test)
    {
      try
      {
        test();
        Console.WriteLine("ok      " + name);
      }
      catch (Exception exception)
      {
        ++failed;
        Console.WriteLine("FAILED  " + name + ": " + exception);
      }
    }

    static void PrintCallCost()
    {
      uint sum = 0;
      for (int i = 0; i < 1000; ++i) sum += Native.NativeCalls.sunder_features();
      Stopwatch watch = Stopwatch.StartNew();
      for (int i = 0; i < 10000000; ++i) sum += Native.NativeCalls.sunder_features();
      Console.WriteLine("a call: " + (watch.Elapsed.TotalMilliseconds / 10).ToString("0.0") + " ns" + (sum == 0 ? "!" : ""));
    }

    static int Main(string[] arguments)
    {
      switch (arguments[0])
      {
        case "digests":
          PrintDigests.Run(arguments[1], int.Parse(arguments[2]), arguments[3]);
          break;
        case "calls":
          PrintCallCost();
          break;
        case "tests":
          byte[] glb = File.ReadAllBytes(Path.Combine(arguments[1], "tube.glb"));
          Character tube = Character.FromGlb(glb);
          Run("layouts", () => {
            LayoutCheck check = new LayoutCheck();
            Layouts.Check(check);
            Expect.That(check.Count > 500, "layouts were compared: " + check.Count);
          });
          Run("operations", () => Laws.Operations(tube));
          foreach (string file in Directory.GetFiles(arguments[1], "*.glb"))
            Run("arrays of " + Path.GetFileName(file), () => { using (Character character = Character.FromGlb(File.ReadAllBytes(file))) Laws.Arrays(character); });
          foreach (string file in Directory.GetFiles(arguments[1], "*.glb"))
            Run("ragdoll of " + Path.GetFileName(file), () => { using (Character character = Character.FromGlb(File.ReadAllBytes(file))) Ragdolls.Check(character); });
          Run("limits of ragdolls", () => Ragdolls.Limits(tube));
          Run("authored tissue", () => Laws.Authored(tube));
          Run("tissues", () => Laws.Tissues(tube));
          Run("transfers", () => Laws.Transfers(tube));
          Run("clips", () => Laws.Clips(tube));
          Run("vertex targets", () => Laws.VertexTargets(tube));
          Run("finalizers", () => Laws.Finalizers(glb));
          Run("threads", () => Laws.Threads(tube));
          Run("disposed objects", () => Misuse.DisposedObjects(tube));
          Run("stale views", () => Misuse.StaleViews(tube));
          Run("wrong arrays", () => Misuse.WrongArrays(tube));
          Run("failed updates", () => Misuse.FailedUpdates(tube));
          Run("versions", Misuse.VersionsAreChecked);
          Run("wrong arrays of a character", Misuse.WrongCharacterArrays);
          Run("file readers", Misuse.FileReaders);
          Run("frames without garbage", () => Frames.Run(tube));
          break;
        default:
          Console.Error.WriteLine("usage: tests FOLDER_OF_MODELS | digests FOLDER COUNT FILE | calls");
          return 2;
      }
      return failed == 0 ? 0 : 1;
    }
  }
}
