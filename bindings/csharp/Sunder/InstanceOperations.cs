using System;
using System.Text;
using Sunder.Native;

namespace Sunder
{
  // Operations: applied by the next update of the scene, in the pose that the instance then has.
  public sealed unsafe partial class Instance
  {
    Command Submitted(Status status, ulong id)
    {
      Check(status);
      return new Command(Scene, id);
    }

    /// <summary>Tears along positions of a blade, each from outside the surface to how deep it reaches.</summary>
    public Command Tear(BladePosition[] blades, TearOptions? options = null, SubmitFlags flags = SubmitFlags.None)
    {
      if (blades == null) throw new ArgumentNullException("blades");
      TearOptions chosen = options ?? TearOptions.Default;
      ulong id;
      fixed (BladePosition* first = blades)
        return Submitted(NativeCalls.sunder_submit_tear(SceneNumber, Id, first, (uint)blades.Length, &chosen, (uint)flags, &id), id);
    }

    /// <summary>Cuts by a plane: PlaneCut.Default with a point and a normal. bounds: corners of a convex polygon; sections: only the
    /// section nearest to each place is cut; bone: only sections that this bone's branch moves. null: no such limit.</summary>
    public Command Cut(PlaneCut cut, Vector3d[] bounds = null, Vector3d[] sections = null, string bone = null, SubmitFlags flags = SubmitFlags.None)
    {
      Library.CheckNotEmpty(bounds, "bounds");
      Library.CheckNotEmpty(sections, "sections");
      ulong id;
      fixed (Vector3d* firstBound = bounds)
      fixed (Vector3d* firstSection = sections)
      fixed (byte* name = Utf8.Write(bone))
      {
        cut.Bounds = (double*)firstBound;
        cut.BoundCount = bounds == null ? 0 : (uint)bounds.Length;
        cut.Sections = (double*)firstSection;
        cut.SectionCount = sections == null ? 0 : (uint)sections.Length;
        cut.Bone = name;
        return Submitted(NativeCalls.sunder_submit_cut(SceneNumber, Id, &cut, (uint)flags, &id), id);
      }
    }

    /// <summary>Bores a round hole: Bore.Default with an origin, a direction, a radius and a depth.</summary>
    public Command Drill(Bore bore, SubmitFlags flags = SubmitFlags.None)
    {
      ulong id;
      return Submitted(NativeCalls.sunder_submit_drill(SceneNumber, Id, &bore, (uint)flags, &id), id);
    }

    /// <summary>Closes wounds whose lips lie on one another. places: only the wound nearest to each, and no farther along it
    /// than reach; 0: to its ends.</summary>
    public Command Weld(Vector3d[] places = null, double reach = 0, SubmitFlags flags = SubmitFlags.None)
    {
      Library.CheckNotEmpty(places, "places");
      ulong id;
      global::Sunder.Weld weld = global::Sunder.Weld.Default;
      fixed (Vector3d* first = places)
      {
        weld.Places = (double*)first;
        weld.PlaceCount = places == null ? 0 : (uint)places.Length;
        weld.Reach = reach;
        return Submitted(NativeCalls.sunder_submit_weld(SceneNumber, Id, &weld, (uint)flags, &id), id);
      }
    }

    /// <summary>Ties threads between lips that lie on one another. places: as for Weld(); the other fields: of suture.</summary>
    public Command Suture(global::Sunder.Suture suture, Vector3d[] places = null, SubmitFlags flags = SubmitFlags.None)
    {
      Library.CheckNotEmpty(places, "places");
      ulong id;
      global::Sunder.Suture sewn = suture;
      fixed (Vector3d* first = places)
      {
        sewn.Places = (double*)first;
        sewn.PlaceCount = places == null ? 0 : (uint)places.Length;
        return Submitted(NativeCalls.sunder_submit_suture(SceneNumber, Id, &sewn, (uint)flags, &id), id);
      }
    }

    /// <summary>Takes a connected piece off: Detachment.Default with a point, or a mesh and a triangle. bone: with a point, only
    /// triangles that this bone moves most.</summary>
    public Command Detach(Detachment detachment, string bone = null)
    {
      ulong id;
      fixed (byte* name = Utf8.Write(bone))
      {
        detachment.Bone = name;
        return Submitted(NativeCalls.sunder_submit_detach(SceneNumber, Id, &detachment, &id), id);
      }
    }

    /// <summary>Begins a stroke over several frames.</summary>
    public Command BeginStroke(BladePosition blade, TearOptions? options = null, StrokeSampling? sampling = null)
    {
      TearOptions chosen = options ?? TearOptions.Default;
      StrokeSampling sampled = sampling ?? StrokeSampling.Default;
      ulong id;
      return Submitted(NativeCalls.sunder_submit_begin_stroke(SceneNumber, Id, &blade, &chosen, &sampled, &id), id);
    }

    /// <summary>seconds: since the last position.</summary>
    public Command ExtendStroke(BladePosition blade, double seconds)
    {
      ulong id;
      return Submitted(NativeCalls.sunder_submit_extend_stroke(SceneNumber, Id, &blade, seconds, &id), id);
    }

    public Command EndStroke()
    {
      ulong id;
      return Submitted(NativeCalls.sunder_submit_end_stroke(SceneNumber, Id, &id), id);
    }

    public Command CancelStroke()
    {
      ulong id;
      return Submitted(NativeCalls.sunder_submit_cancel_stroke(SceneNumber, Id, &id), id);
    }

    public Command Undo()
    {
      ulong id;
      return Submitted(NativeCalls.sunder_submit_undo(SceneNumber, Id, &id), id);
    }

    public Command Redo()
    {
      ulong id;
      return Submitted(NativeCalls.sunder_submit_redo(SceneNumber, Id, &id), id);
    }

    /// <summary>How many operations undo and redo can take.</summary>
    public void GetUndoCounts(out int undo, out int redo)
    {
      uint undone, redone;
      Check(NativeCalls.sunder_get_undo_counts(SceneNumber, Id, &undone, &redone));
      undo = (int)undone;
      redo = (int)redone;
    }

    /// <summary>Takes now the memory that the first operation would take. O(size of the character).</summary>
    public void PrepareToTear() { Changed(NativeCalls.sunder_prepare_to_tear(SceneNumber, Id)); }

    /// <summary>The operations that are done and not undone, as JSON that makes the same model again, bit for bit.</summary>
    public string Log
    {
      get
      {
        uint bytes;
        Check(NativeCalls.sunder_get_log(SceneNumber, Id, &bytes));
        return Library.TakeText(bytes);
      }
    }

    /// <summary>Applies a log at once, in the poses that it names, and returns the number of its operations. Throws at the first that
    /// fails, with its number as the index; those before it stay.</summary>
    public int ApplyLog(string json)
    {
      if (json == null) throw new ArgumentNullException("json");
      byte[] text = Encoding.UTF8.GetBytes(json);
      uint applied;
      fixed (byte* first = text) Changed(NativeCalls.sunder_apply_log(SceneNumber, Id, first, (ulong)text.Length, &applied));
      return (int)applied;
    }

    /// <summary>A hash of all bits of the torn model: equal on every machine. 0: nothing was torn yet.</summary>
    public ulong Digest
    {
      get
      {
        ulong digest;
        Check(NativeCalls.sunder_get_digest(SceneNumber, Id, &digest));
        return digest;
      }
    }
  }
}
