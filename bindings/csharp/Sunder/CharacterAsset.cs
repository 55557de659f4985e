using System;
using Sunder.Native;

namespace Sunder
{
  /// <summary>What the instances of one character share. Immutable: any thread may use it.</summary>
  public sealed unsafe class CharacterAsset : IDisposable
  {
    readonly AssetHandle handle;
    readonly Epoch epoch;

    /// <summary>O(size of the character): on a loading thread. materials: of soft tissue; all starts with the first; null: the default one. coarser: a coarser
    /// level with the same bones, which options.CoarserBelow speaks of. authored: where soft tissue differs; null: nowhere.</summary>
    public CharacterAsset(Character character, AssetOptions? options = null, TissueMaterial[] materials = null, CharacterAsset coarser = null,
      AuthoredTissue authored = null)
    {
      if (character == null) throw new ArgumentNullException("character");
      Library.CheckNotEmpty(materials, "materials");
      Character = character;
      AssetOptions chosen = options ?? AssetOptions.Default;
      if (coarser != null) chosen.Coarser = coarser.Number;
      uint number;
      using (NativeMemory memory = new NativeMemory())
      fixed (TissueMaterial* first = materials)
      {
        if (authored != null) authored.Write(memory, ref chosen);
        if (materials != null)
        {
          chosen.Materials = first;
          chosen.MaterialCount = (uint)materials.Length;
        }
        SunderException.Check(NativeCalls.sunder_create_asset(character.Number, &chosen, &number));
      }
      GC.KeepAlive(coarser);
      handle = new AssetHandle(number);
      epoch = new Epoch(handle, "");
    }

    public Character Character { get; private set; }

    internal uint Number { get { return handle.Number; } }

    /// <summary>The index buffer of a mesh before any tear, 3 per triangle.</summary>
    public UIntView GetTriangles(int mesh)
    {
      DrawRangeView ranges;
      return GetTriangles(mesh, out ranges);
    }

    /// <summary>ranges: its draw calls.</summary>
    public UIntView GetTriangles(int mesh, out DrawRangeView ranges)
    {
      uint* triangles;
      DrawRange* first;
      uint triangleCount, rangeCount;
      SunderException.Check(NativeCalls.sunder_get_asset_triangles(Number, (uint)mesh, &triangles, &triangleCount, &first, &rangeCount));
      GC.KeepAlive(this);
      ranges = new DrawRangeView(first, rangeCount, epoch.Now);
      return new UIntView(triangles, 3ul * triangleCount, epoch.Now);
    }

    /// <summary>Scenes with its instances stay.</summary>
    public void Dispose() { handle.Dispose(); }
  }

  /// <summary>Presets of tissue, and what follows from them.</summary>
  public static unsafe class Tissue
  {
    /// <summary>"skin", "fat", "muscle", "liver", "rubber", "foam", "cloth", "jelly".</summary>
    public static TissueMaterial Find(string name)
    {
      TissueMaterial material = TissueMaterial.Default;
      fixed (byte* text = Utf8.Write(name)) SunderException.Check(NativeCalls.sunder_find_material(text, &material));
      return material;
    }

    /// <summary>The tension, N/m, under which a straight wound of `length` opens by `gap` metres in its middle.</summary>
    public static double TensionForGap(TissueMaterial material, double length, double gap)
    {
      Library.Require();
      double tension;
      SunderException.Check(NativeCalls.sunder_tension_for_gap(&material, length, gap, &tension));
      return tension;
    }

    /// <summary>The force, newtons, that a blade feels. lengthTorn: of the frame, OperationResult.Length; depth: of the tip below the
    /// surface; motion: of the tip since the last frame.</summary>
    public static Vector3d BladeForce(CuttingResistance tissue, double lengthTorn, double depth, Vector3d motion)
    {
      Library.Require();
      Vector3d force;
      SunderException.Check(NativeCalls.sunder_blade_force(&tissue, lengthTorn, depth, &motion, &force));
      return force;
    }
  }
}
