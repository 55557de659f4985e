using System;
using Sunder.Native;

namespace Sunder
{
  /// <summary>A bone; its parent is an earlier one, or -1.</summary>
  public struct Bone
  {
    public string Name;
    public int Parent;
    public BoneTransform Rest;
  }

  /// <summary>What loading repaired, dropped or tells.</summary>
  public struct Note
  {
    public NoteKind Kind;
    /// <summary>"mesh 2 'Body'".</summary>
    public string Place;
    public string Text;
    public uint Count;
  }

  /// <summary>A rigged model: meshes and skins on one skeleton, with its clips. Immutable: any thread may use it.</summary>
  public sealed unsafe class Character : IDisposable
  {
    readonly CharacterHandle handle;
    readonly CharacterData data;
    readonly Epoch epoch;

    internal Character(uint number)
    {
      handle = new CharacterHandle(number);
      epoch = new Epoch(handle, "");
      CharacterData read = CharacterData.Default;
      SunderException.Check(NativeCalls.sunder_get_character(number, &read));
      data = read;
    }

    /// <summary>Reads a GLB, or glTF text. strict: refuses what would otherwise be repaired or dropped. readFile: gives the bytes of
    /// another file to which the model refers, or null if it is absent; it stays until the program ends, and may be called from any
    /// thread. Without it such models are refused.</summary>
    public static Character FromGlb(byte[] glb, bool strict = false, Func<string, byte[]> readFile = null)
    {
      if (glb == null) throw new ArgumentNullException("glb");
      Library.Require();
      LoadOptions options = LoadOptions.Default;
      options.IsStrict = strict;
      if (readFile != null) FileReader.Set(ref options, readFile);
      uint number;
      fixed (byte* bytes = glb) SunderException.Check(NativeCalls.sunder_load_glb(bytes, (ulong)glb.LongLength, &options, &number));
      return new Character(number);
    }

    /// <summary>Copies a character from arrays.</summary>
    public static Character FromArrays(CharacterArrays arrays)
    {
      if (arrays == null) throw new ArgumentNullException("arrays");
      Library.Require();
      using (NativeMemory memory = new NativeMemory())
      {
        CharacterData structs = CharacterStructs.Write(arrays, memory);
        uint number;
        SunderException.Check(NativeCalls.sunder_create_character(&structs, &number));
        return new Character(number);
      }
    }

    internal uint Number { get { return handle.Number; } }

    public string Name { get { Check(); return Text(data.Name); } }
    public int BoneCount { get { return (int)data.BoneCount; } }
    public int MeshCount { get { return (int)data.MeshCount; } }
    public int SkinCount { get { return (int)data.SkinCount; } }
    public int ClipCount { get { return (int)data.ClipCount; } }
    public int MorphWeightCount { get { return (int)data.MorphWeightCount; } }
    public FloatView RestMorphWeights { get { return new FloatView(data.RestMorphWeights, data.MorphWeightCount, epoch.Now); } }

    public Bone GetBone(int index)
    {
      Check(index, data.BoneCount);
      Bone bone = new Bone();
      bone.Name = Utf8.Read(data.Bones[index].Name);
      bone.Parent = data.Bones[index].Parent == Constants.None ? -1 : (int)data.Bones[index].Parent;
      bone.Rest = data.Bones[index].Rest;
      GC.KeepAlive(this);
      return bone;
    }

    public MeshView GetMesh(int index)
    {
      Check(index, data.MeshCount);
      MeshView mesh = new MeshView(data.Meshes[index], epoch, epoch);
      GC.KeepAlive(this);
      return mesh;
    }

    /// <summary>Per slot: a bone.</summary>
    public UIntView GetSkinBones(int skin)
    {
      Check(skin, data.SkinCount);
      UIntView bones = new UIntView(data.Skins[skin].Bones, data.Skins[skin].SlotCount, epoch.Now);
      GC.KeepAlive(this);
      return bones;
    }

    /// <summary>Per slot: 12 numbers, column after column, the inverse of the bone's bind transform.</summary>
    public FloatView GetBoneFromBind(int skin)
    {
      Check(skin, data.SkinCount);
      FloatView matrices = new FloatView(data.Skins[skin].BoneFromBind, 12ul * data.Skins[skin].SlotCount, epoch.Now);
      GC.KeepAlive(this);
      return matrices;
    }

    public string GetClipName(int clip) { Check(clip, data.ClipCount); return Text(data.Clips[clip].Name); }
    /// <summary>Seconds.</summary>
    public float GetClipDuration(int clip)
    {
      Check(clip, data.ClipCount);
      float duration = data.Clips[clip].Duration;
      GC.KeepAlive(this);
      return duration;
    }

    /// <summary>Throws if there is none of that name.</summary>
    public int FindBone(string name)
    {
      uint bone;
      fixed (byte* text = Utf8.Write(name)) SunderException.Check(NativeCalls.sunder_find_bone(Number, text, &bone));
      GC.KeepAlive(this);
      return (int)bone;
    }

    /// <summary>Throws if there is none of that name.</summary>
    public int FindClip(string name)
    {
      uint clip;
      fixed (byte* text = Utf8.Write(name)) SunderException.Check(NativeCalls.sunder_find_clip(Number, text, &clip));
      GC.KeepAlive(this);
      return (int)clip;
    }

    /// <summary>A copy in which a mesh has an attribute of one number per vertex, in place of one of that name, which begins with '_'. Files of it have it too.</summary>
    public Character WithAttribute(int mesh, string name, float[] values)
    {
      if (values == null) throw new ArgumentNullException("values");
      uint made;
      fixed (byte* text = Utf8.Write(name))
      fixed (float* first = values)
        SunderException.Check(NativeCalls.sunder_add_attribute(Number, (uint)mesh, text, first, (uint)values.Length, &made));
      GC.KeepAlive(this);
      return new Character(made);
    }

    /// <summary>What loading noted.</summary>
    public Note[] GetNotes()
    {
      Native.Note* notes;
      uint count;
      SunderException.Check(NativeCalls.sunder_get_notes(Number, &notes, &count));
      Note[] copies = new Note[count];
      for (int i = 0; i < copies.Length; ++i)
      {
        copies[i].Kind = notes[i].Kind;
        copies[i].Place = Utf8.Read(notes[i].Place);
        copies[i].Text = Utf8.Read(notes[i].Text);
        copies[i].Count = notes[i].Count;
      }
      GC.KeepAlive(this);
      return copies;
    }

    /// <summary>The transforms of a clip at a time: one per bone, and per morph weight (or null), written.</summary>
    public void SampleClip(int clip, double seconds, BoneTransform[] transforms, float[] morphWeights = null)
    {
      Library.CheckLength(transforms, BoneCount, "transforms");
      if (morphWeights != null) Library.CheckLength(morphWeights, MorphWeightCount, "morphWeights");
      fixed (BoneTransform* to = transforms)
      fixed (float* weights = morphWeights)
        SunderException.Check(NativeCalls.sunder_sample_clip(Number, (uint)clip, seconds, to, weights));
      GC.KeepAlive(this);
    }

    /// <summary>12 numbers per bone, column after column, written: model_from_bone. transforms: null: the rest pose.</summary>
    public void ComputeMatrices(BoneTransform[] transforms, double[] modelFromBone)
    {
      if (transforms != null) Library.CheckLength(transforms, BoneCount, "transforms");
      Library.CheckLength(modelFromBone, 12L * BoneCount, "modelFromBone");
      fixed (BoneTransform* from = transforms)
      fixed (double* to = modelFromBone)
        SunderException.Check(NativeCalls.sunder_compute_matrices(Number, from, to));
      GC.KeepAlive(this);
    }

    /// <summary>The character as a file.</summary>
    public byte[] ToGlb(SaveOptions? options = null)
    {
      SaveOptions chosen = options ?? SaveOptions.Default;
      uint bytes;
      SunderException.Check(NativeCalls.sunder_save_glb(Number, &chosen, &bytes));
      GC.KeepAlive(this);
      return Library.Take(bytes);
    }

    /// <summary>Assets and scenes that were made from it stay.</summary>
    public void Dispose() { handle.Dispose(); }

    /// <summary>Keeps the character, whose text it is, until it was read.</summary>
    string Text(byte* text)
    {
      string read = Utf8.Read(text);
      GC.KeepAlive(this);
      return read;
    }

    void Check() { uint unused = handle.Number; }

    void Check(int index, uint count)
    {
      Check();
      if ((uint)index >= count) throw Epoch.OutOfRange(index, (int)count);
    }
  }
}
