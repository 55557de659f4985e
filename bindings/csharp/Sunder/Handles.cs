using System;
using System.Runtime.InteropServices;
using Sunder.Native;

namespace Sunder
{
  /// <summary>The number of an object of the library, which is destroyed with it. Numbers are never used again, so a call that comes
  /// after Dispose() gets an error. Dispose() must not run while another thread uses the object: nothing waits for a call or a read of
  /// the library's memory that has begun.</summary>
  public abstract class LibraryHandle : SafeHandle
  {
    internal readonly string Kind;

    internal LibraryHandle(string kind, uint number) : base(IntPtr.Zero, true)
    {
      Kind = kind;
      SetHandle(new IntPtr(unchecked((int)number)));  // a pointer may have 32 bits, as on WebGL
    }

    public override bool IsInvalid { get { return handle == IntPtr.Zero; } }

    /// <summary>The number. Whoever uses it keeps this object alive until the call returns.</summary>
    internal uint Number
    {
      get
      {
        if (IsClosed) throw new ObjectDisposedException(Kind);
        return Raw;
      }
    }

    internal uint Raw { get { return unchecked((uint)handle.ToInt64()); } }
  }

  sealed class CharacterHandle : LibraryHandle
  {
    internal CharacterHandle(uint number) : base("Character", number) { }
    protected override bool ReleaseHandle() { return NativeCalls.sunder_destroy_character(Raw) == Status.Ok; }
  }

  sealed class AssetHandle : LibraryHandle
  {
    internal AssetHandle(uint number) : base("CharacterAsset", number) { }
    protected override bool ReleaseHandle() { return NativeCalls.sunder_destroy_asset(Raw) == Status.Ok; }
  }

  sealed class SceneHandle : LibraryHandle
  {
    internal SceneHandle(uint number) : base("Scene", number) { }
    protected override bool ReleaseHandle() { return NativeCalls.sunder_destroy_scene(Raw) == Status.Ok; }
  }

  sealed class PieceHandle : LibraryHandle
  {
    internal PieceHandle(uint number) : base("Piece", number) { }
    protected override bool ReleaseHandle() { return NativeCalls.sunder_destroy_piece(Raw) == Status.Ok; }
  }

  sealed class RagdollHandle : LibraryHandle
  {
    internal RagdollHandle(uint number) : base("Ragdoll", number) { }
    protected override bool ReleaseHandle() { return NativeCalls.sunder_destroy_ragdoll(Raw) == Status.Ok; }
  }

  sealed class ReportHandle : LibraryHandle
  {
    internal ReportHandle(uint number) : base("ValidationReport", number) { }
    protected override bool ReleaseHandle() { return NativeCalls.sunder_destroy_report(Raw) == Status.Ok; }
  }
}
