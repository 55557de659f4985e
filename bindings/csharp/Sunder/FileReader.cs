using System;
using System.Collections.Generic;
using System.Runtime.InteropServices;
using Sunder.Native;

namespace Sunder
{
  /// <summary>Marks static methods that the library calls, for compilation ahead of time: IL2CPP looks for an attribute of this name.</summary>
  [AttributeUsage(AttributeTargets.Method)]
  sealed class MonoPInvokeCallbackAttribute : System.Attribute
  {
    public MonoPInvokeCallbackAttribute(Type type) { Type = type; }
    public Type Type { get; private set; }
  }

  /// <summary>Gives the library the other files to which a model refers. The library may ask for them as long as anything that was
  /// made from the model exists, so a reader stays until the program ends.</summary>
  static unsafe class FileReader
  {
    static readonly ReadFile read = Read;
    static readonly ReleaseFile release = Release;
    static readonly List<Func<string, byte[]>> readers = new List<Func<string, byte[]>>();
    static readonly Dictionary<IntPtr, GCHandle> lent = new Dictionary<IntPtr, GCHandle>();

    internal static void Set(ref LoadOptions options, Func<string, byte[]> reader)
    {
      lock (lent)
      {
        readers.Add(reader);
        options.FileContext = (void*)new IntPtr(readers.Count);
      }
      options.ReadFile = Marshal.GetFunctionPointerForDelegate(read);
      options.ReleaseFile = Marshal.GetFunctionPointerForDelegate(release);
    }

    /// <summary>No exception may leave it: frames of C++ are below.</summary>
    [MonoPInvokeCallback(typeof(ReadFile))]
    static Status Read(void* context, byte* uri, byte** data, ulong* size)
    {
      try
      {
        Func<string, byte[]> reader;
        lock (lent) reader = readers[(int)new IntPtr(context) - 1];
        byte[] bytes = reader(Utf8.Read(uri));
        if (bytes == null) return Status.FileNotFound;
        IntPtr address;
        lock (lent)
        {
          // An empty array has no address. One that is lent already is copied: each is released by its own address.
          GCHandle pinned = GCHandle.Alloc(bytes.Length > 0 ? bytes : new byte[1], GCHandleType.Pinned);
          if (lent.ContainsKey(pinned.AddrOfPinnedObject()))
          {
            pinned.Free();
            pinned = GCHandle.Alloc(bytes.Clone(), GCHandleType.Pinned);
          }
          address = pinned.AddrOfPinnedObject();
          lent.Add(address, pinned);
        }
        *data = (byte*)address;
        *size = (ulong)bytes.Length;
        return Status.Ok;
      }
      catch (Exception)
      {
        return Status.FileUnreadable;
      }
    }

    [MonoPInvokeCallback(typeof(ReleaseFile))]
    static void Release(void* context, byte* data)
    {
      lock (lent)
      {
        GCHandle pinned;
        if (!lent.TryGetValue((IntPtr)data, out pinned)) return;
        pinned.Free();
        lent.Remove((IntPtr)data);
      }
    }
  }
}
