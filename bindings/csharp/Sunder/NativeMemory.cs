using System;
using System.Collections.Generic;
using System.Runtime.InteropServices;

namespace Sunder
{
  /// <summary>Arguments of a call: pinned arrays, texts, and memory for structs. Freed by Dispose().</summary>
  sealed unsafe class NativeMemory : IDisposable
  {
    readonly List<GCHandle> pinned = new List<GCHandle>();
    readonly List<IntPtr> blocks = new List<IntPtr>();

    /// <summary>The address of an array's first element; null for none.</summary>
    internal void* Pin(Array array)
    {
      if (array == null || array.Length == 0) return null;
      GCHandle handle = GCHandle.Alloc(array, GCHandleType.Pinned);
      pinned.Add(handle);
      return (void*)handle.AddrOfPinnedObject();
    }

    internal byte* Text(string text) { return (byte*)Pin(Utf8.Write(text)); }

    /// <summary>Zeros; null for no bytes.</summary>
    internal void* Take(long bytes)
    {
      if (bytes == 0) return null;
      IntPtr block = Marshal.AllocHGlobal(new IntPtr(bytes));
      blocks.Add(block);
      for (long i = 0; i < bytes; ++i) ((byte*)block)[i] = 0;
      return (void*)block;
    }

    public void Dispose()
    {
      foreach (GCHandle handle in pinned) handle.Free();
      foreach (IntPtr block in blocks) Marshal.FreeHGlobal(block);
      pinned.Clear();
      blocks.Clear();
    }
  }
}
