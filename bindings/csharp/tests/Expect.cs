using System;

namespace Sunder.Tests
{
  sealed class TestFailure : Exception
  {
    internal TestFailure(string text) : base(text) { }
  }

  static class Expect
  {
    internal static void That(bool holds, string what)
    {
      if (!holds) throw new TestFailure(what);
    }

    internal static void Equal<T>(T have, T want, string what)
    {
      if (!Equals(have, want)) throw new TestFailure(what + ": " + have + "; " + want + " was expected");
    }

    internal static void Near(double have, double want, double most, string what)
    {
      if (!(Math.Abs(have - want) <= most)) throw new TestFailure(what + ": " + have + " is not within " + most + " of " + want);
    }

    /// <summary>The text of what an action throws, which has the given words.</summary>
    internal static E Throws<E>(Action act, string words) where E : Exception
    {
      try
      {
        act();
      }
      catch (E exception)
      {
        That(exception.Message.Contains(words), "\"" + exception.Message + "\" does not have \"" + words + "\"");
        return exception;
      }
      catch (Exception other)
      {
        throw new TestFailure(typeof(E).Name + " \"" + words + "\" was expected; " + other.GetType().Name + ": " + other.Message);
      }
      throw new TestFailure(typeof(E).Name + " \"" + words + "\" was expected; nothing was thrown");
    }

    /// <summary>A failure of the library, of a kind.</summary>
    internal static SunderException Fails(Action act, Status code, string words = "")
    {
      SunderException exception = Throws<SunderException>(act, words);
      Equal(exception.Code, code, "code of \"" + exception.Message + "\"");
      return exception;
    }
  }

  /// <summary>Compares sizes, offsets and constants with those of the C compiler.</summary>
  sealed class LayoutCheck
  {
    internal int Count;

    internal void Same(string what, long have, long want)
    {
      Expect.Equal(have, want, what);
      ++Count;
    }
  }
}
