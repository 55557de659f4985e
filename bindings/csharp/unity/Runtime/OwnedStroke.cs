using System.Collections.Generic;

namespace Sunder.Unity
{
  /// <summary>The stroke of a character, and whose it is: an instance has one at a time, and who went on with that of another, or ended
  /// it, would tear where the other cuts. The library refuses a stroke while a program has one open by Instance.BeginStroke(), so
  /// positions wait here until it has begun this one.</summary>
  sealed class OwnedStroke
  {
    struct Position
    {
      internal BladePosition Blade;
      internal double Seconds;
    }

    readonly List<Position> waiting = new List<Position>(4);
    object owner;
    Command command;
    bool hasBegun, endsWhenBegun;

    internal bool IsFree { get { return owner == null; } }

    internal bool IsOf(object who) { return owner == who && owner != null && !endsWhenBegun; }

    internal bool Begin(Instance instance, object who, BladePosition blade, TearOptions? options, StrokeSampling? sampling)
    {
      if (!IsFree) return false;
      command = instance.BeginStroke(blade, options, sampling);
      owner = who;
      return true;
    }

    internal bool Extend(Instance instance, object who, BladePosition blade, double seconds)
    {
      if (!IsOf(who)) return false;
      if (hasBegun) instance.ExtendStroke(blade, seconds);
      else waiting.Add(new Position { Blade = blade, Seconds = seconds });
      return true;
    }

    /// <summary>Ends it, whose it ever is.</summary>
    internal void End(Instance instance)
    {
      if (IsFree) return;
      endsWhenBegun = !hasBegun;
      if (!hasBegun) return;
      Forget();
      instance.EndStroke();
    }

    /// <summary>An update has applied a command of the character.</summary>
    internal void Hear(Instance instance, OperationResult result)
    {
      if (IsFree || hasBegun || result.Command != command.Id) return;
      if (!result.Succeeded)
      {
        Forget();
        return;
      }
      hasBegun = true;
      for (int i = 0; i < waiting.Count; ++i) instance.ExtendStroke(waiting[i].Blade, waiting[i].Seconds);
      waiting.Clear();
      if (endsWhenBegun) End(instance);
    }

    internal void Forget()
    {
      owner = null;
      hasBegun = endsWhenBegun = false;
      waiting.Clear();
    }
  }
}
