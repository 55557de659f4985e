using System;

namespace Sunder
{
  /// <summary>An array of the library was read after a call that changed what it shows. Ask for it again.</summary>
  public sealed class StaleViewException : InvalidOperationException
  {
    internal StaleViewException(string text) : base(text) { }
  }

  /// <summary>Counts what makes views invalid, and keeps alive what they look at.</summary>
  sealed class Epoch
  {
    readonly LibraryHandle owner;
    readonly string text;

    internal Epoch(LibraryHandle owner, string text)
    {
      this.owner = owner;
      this.text = text;
    }

    internal int Version { get; private set; }

    internal void Advance() { ++Version; }

    internal Moment Now { get { return new Moment(this, Version); } }

    internal void Check(int version)
    {
      if (owner.IsClosed) throw new ObjectDisposedException(owner.Kind);
      if (version != Version) throw new StaleViewException(text);
    }

    internal static int CountOf(ulong count)
    {
      if (count > int.MaxValue) throw new OverflowException("an array of " + count + " elements is longer than a view can be");
      return (int)count;
    }

    internal static Exception OutOfRange(int index, int count)
    {
      return new ArgumentOutOfRangeException("index", index, "the array has " + count + " elements");
    }

    internal static string NoRoom(int length, int at, int count)
    {
      return "an array of " + length + " elements has no room for " + count + " from " + at + " on";
    }
  }

  /// <summary>When a view was made.</summary>
  readonly struct Moment
  {
    readonly Epoch epoch;
    readonly int version;

    internal Moment(Epoch epoch, int version)
    {
      this.epoch = epoch;
      this.version = version;
    }

    /// <summary>Throws if what is seen has changed since. Without an epoch nothing is seen.</summary>
    internal void Check() { if (epoch != null) epoch.Check(version); }

    /// <summary>After the last read of the library's memory: until then the collector does not destroy what owns it.</summary>
    internal void KeepAlive() { GC.KeepAlive(epoch); }
  }
}
