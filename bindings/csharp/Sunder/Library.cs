using System;
using System.Runtime.InteropServices;
using Sunder.Native;

namespace Sunder
{
  /// <summary>The C library that was found.</summary>
  public static unsafe class Library
  {
    static bool isChecked;

    /// <summary>Throws if the library is of another version than this binding. Whatever makes an object, and Default of each struct, calls it first.</summary>
    public static void Require()
    {
      if (isChecked) return;
      SunderException.Check(NativeCalls.sunder_check_abi(Constants.CVersion, 0));
      isChecked = true;
    }

    /// <summary>"0.1.0".</summary>
    public static string Version
    {
      get
      {
        uint version = NativeCalls.sunder_version();
        return (version >> 16) + "." + (version >> 8 & 255) + "." + (version & 255);
      }
    }

    /// <summary>Parts that a build may lack.</summary>
    public static Features Features { get { return (Features)NativeCalls.sunder_features(); } }

    /// <summary>A copy of bytes that a call has made; the library's are destroyed.</summary>
    internal static byte[] Take(uint bytes)
    {
      try
      {
        byte* data;
        ulong size;
        SunderException.Check(NativeCalls.sunder_get_bytes(bytes, &data, &size));
        byte[] copy = new byte[size];
        if (size > 0) Marshal.Copy((IntPtr)data, copy, 0, copy.Length);
        return copy;
      }
      finally
      {
        NativeCalls.sunder_destroy_bytes(bytes);
      }
    }

    internal static string TakeText(uint bytes) { return System.Text.Encoding.UTF8.GetString(Take(bytes)); }

    /// <summary>Refuses an array without elements where null stands for all: a list that turned out empty would get them.</summary>
    internal static void CheckNotEmpty(Array array, string name)
    {
      if (array != null && array.Length == 0) throw new ArgumentException(name + " is empty: leave it out (null) to have the default", name);
    }

    /// <summary>Refuses an array of which the library would read too much.</summary>
    internal static void CheckLength(Array array, long wanted, string name)
    {
      if (array == null) throw new ArgumentNullException(name);
      if (array.LongLength != wanted) throw new ArgumentException(name + " has " + array.LongLength + " elements; " + wanted + " are needed", name);
    }
  }
}
