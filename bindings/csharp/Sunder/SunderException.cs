using System;
using Sunder.Native;

namespace Sunder
{
  /// <summary>A call of the library failed, and changed nothing.</summary>
  public sealed class SunderException : Exception
  {
    /// <summary>The kind of failure.</summary>
    public Status Code { get; private set; }

    /// <summary>What is wrong, where, and what was expected.</summary>
    public string Text { get; private set; }

    /// <summary>The element of which the text speaks, or null.</summary>
    public uint? Index { get; private set; }

    internal SunderException(Status code, string text, uint index) : base(text + " (" + NameOf(code) + ")")
    {
      Code = code;
      Text = text;
      Index = index == Constants.None ? (uint?)null : index;
    }

    static unsafe string NameOf(Status code) { return Utf8.Read(NativeCalls.sunder_status_name(code)); }

    /// <summary>Throws the last failure of this thread, if the status is one.</summary>
    public static void Check(Status status)
    {
      if (status != Status.Ok) Throw(status);
    }

    static unsafe void Throw(Status status)
    {
      throw new SunderException(status, Utf8.Read(NativeCalls.sunder_last_error()), NativeCalls.sunder_last_error_index());
    }
  }
}
