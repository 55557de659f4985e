using System;
using System.Collections.Generic;
using Sunder.Native;

namespace Sunder
{
  /// <summary>Weights of one model given to another that stands in the same place; docs/transfer.md explains the options.</summary>
  public sealed unsafe class SkinTransfer : IDisposable
  {
    /// <summary>The target with its new skin.</summary>
    public Character Character { get; private set; }
    public TransferInfo Info { get; private set; }
    /// <summary>How each vertex of the target got its weights, all meshes one after the other.</summary>
    public TransferOutcome[] Outcomes { get; private set; }

    SkinTransfer() { }

    /// <summary>sourceOfTarget: bones that are the same though their names differ. bones: of the source, whose weights are transferred;
    /// null: all. locked: per vertex of the target, whether it keeps its weights; or null.</summary>
    public static SkinTransfer Make(Character source, Character target, TransferOptions? options = null,
      IDictionary<string, string> sourceOfTarget = null, string[] bones = null, bool[] locked = null)
    {
      if (source == null) throw new ArgumentNullException("source");
      if (target == null) throw new ArgumentNullException("target");
      Library.CheckNotEmpty(bones, "bones");
      int vertices = 0;
      for (int i = 0; i < target.MeshCount; ++i) vertices += target.GetMesh(i).VertexCount;
      TransferOptions chosen = options ?? TransferOptions.Default;
      byte[] outcomes = new byte[vertices];
      using (NativeMemory memory = new NativeMemory())
      {
        WriteBones(ref chosen, memory, sourceOfTarget, bones);
        if (locked != null)
        {
          Library.CheckLength(locked, vertices, "locked");
          chosen.Locked = (byte*)memory.Pin(Array.ConvertAll(locked, one => one ? (byte)1 : (byte)0));
          chosen.LockedCount = (uint)vertices;
        }
        TransferInfo info = TransferInfo.Sized;
        uint character;
        fixed (byte* to = outcomes) SunderException.Check(NativeCalls.sunder_transfer(source.Number, target.Number, &chosen, &character, &info, to));
        GC.KeepAlive(source);
        GC.KeepAlive(target);
        return new SkinTransfer { Character = new Character(character), Info = info, Outcomes = Array.ConvertAll(outcomes, one => (TransferOutcome)one) };
      }
    }

    static void WriteBones(ref TransferOptions options, NativeMemory memory, IDictionary<string, string> sourceOfTarget, string[] bones)
    {
      if (sourceOfTarget != null)
      {
        BoneNames* names = (BoneNames*)memory.Take((long)sourceOfTarget.Count * sizeof(BoneNames));
        options.BoneNames = names;
        options.BoneNameCount = (uint)sourceOfTarget.Count;
        foreach (KeyValuePair<string, string> pair in sourceOfTarget)
        {
          names->Target = memory.Text(pair.Key);
          names->Source = memory.Text(pair.Value);
          ++names;
        }
      }
      if (bones == null) return;
      options.Bones = (byte**)memory.Take((long)bones.Length * sizeof(byte*));
      options.BoneCount = (uint)bones.Length;
      for (int i = 0; i < bones.Length; ++i) options.Bones[i] = memory.Text(bones[i]);
    }

    public void Dispose() { Character.Dispose(); }
  }
}
