using System;
using Sunder.Native;

namespace Sunder
{
  // Tissue of soft instances, and contact with the drawn surface. Both need PrepareToTear() or an operation before.
  public sealed unsafe partial class Instance
  {
    public TissueInfo TissueInfo
    {
      get
      {
        TissueInfo info = Sunder.TissueInfo.Sized;
        Check(NativeCalls.sunder_get_tissue(SceneNumber, Id, &info));
        return info;
      }
    }

    /// <summary>The threads of all sutures, in the order in which they were tied.</summary>
    public SutureThread[] Threads
    {
      get
      {
        SutureThread* threads;
        uint count;
        Check(NativeCalls.sunder_get_threads(SceneNumber, Id, &threads, &count));
        var copied = new SutureThread[count];
        for (uint i = 0; i < count; ++i) copied[i] = threads[i];
        return copied;
      }
    }

    /// <summary>The point of the surface at a vertex; null: it has none any more.</summary>
    public uint? GetPoint(int mesh, int vertex)
    {
      uint point;
      Check(NativeCalls.sunder_get_point(SceneNumber, Id, (uint)mesh, (uint)vertex, &point));
      return point == Constants.None ? (uint?)null : point;
    }

    /// <summary>Pulls a point to a place. stiffness: 1/s^2; 0: the default.</summary>
    public Hold HoldPoint(uint point, Vector3d target, double stiffness = 0)
    {
      ulong hold;
      Check(NativeCalls.sunder_hold_point(SceneNumber, Id, point, &target, stiffness, &hold));
      return new Hold(this, hold);
    }

    /// <summary>Gives the tissue at a point an impulse.</summary>
    public void Push(uint point, Vector3d newtonSeconds) { Check(NativeCalls.sunder_add_impulse(SceneNumber, Id, point, &newtonSeconds)); }

    public void SetGravity(Vector3d gravity) { Check(NativeCalls.sunder_set_gravity(SceneNumber, Id, &gravity)); }

    public void SetTension(double newtonsPerMetre, bool addsPoseStrain = false)
    {
      Check(NativeCalls.sunder_set_tension(SceneNumber, Id, newtonsPerMetre, addsPoseStrain ? 1u : 0u));
    }

    /// <summary>Changes a material wherever it is used.</summary>
    public void ChangeMaterial(int index, TissueMaterial material) { Check(NativeCalls.sunder_change_material(SceneNumber, Id, (uint)index, &material)); }

    /// <summary>Tears at once, at one place at most, where tissue gives way in the pose of the last update. The next update draws it.</summary>
    public ForceTearing TearOverstretched(ForceTearingOptions? options = null)
    {
      ForceTearingOptions chosen = options ?? ForceTearingOptions.Default;
      ForceTearing found = ForceTearing.Sized;
      Changed(NativeCalls.sunder_tear_overstretched(SceneNumber, Id, &chosen, &found));
      return found;
    }

    /// <summary>Replaces all colliders.</summary>
    public void SetColliders(params TissueCollider[] colliders)
    {
      if (colliders == null) throw new ArgumentNullException("colliders");
      fixed (TissueCollider* first = colliders) Check(NativeCalls.sunder_set_colliders(SceneNumber, Id, first, (uint)colliders.Length));
    }

    /// <summary>The position of a collider at the end of the next update; its velocity follows.</summary>
    public void MoveCollider(int collider, Vector3d place, Vector4d rotation)
    {
      Check(NativeCalls.sunder_move_collider(SceneNumber, Id, (uint)collider, &place, &rotation));
    }

    /// <summary>Lets the soft instance of a piece, not updated yet, move on as the piece did.</summary>
    public void InheritMotion(Piece piece)
    {
      if (piece == null) throw new ArgumentNullException("piece");
      Check(NativeCalls.sunder_inherit_motion(SceneNumber, Id, piece.Number));
      GC.KeepAlive(piece);
    }

    /// <summary>The first place where a ray meets the surface as it was drawn last.</summary>
    public bool CastRay(Vector3d origin, Vector3d direction, double length, out SurfaceContact contact)
    {
      SurfaceContact found;
      uint hit;
      Check(NativeCalls.sunder_cast_ray(SceneNumber, Id, &origin, &direction, length, &found, &hit));
      contact = hit != 0 ? found : default(SurfaceContact);
      return hit != 0;
    }

    public bool FindNearest(Vector3d point, double mostDistance, out SurfaceContact contact)
    {
      SurfaceContact found;
      uint hit;
      Check(NativeCalls.sunder_find_nearest(SceneNumber, Id, &point, mostDistance, &found, &hit));
      contact = hit != 0 ? found : default(SurfaceContact);
      return hit != 0;
    }

    /// <summary>All places where a blade crosses the surface, from base to tip; as many as there is room for are written. Returns the
    /// number of all.</summary>
    public int FindBladeContacts(BladePosition blade, SurfaceContact[] contacts)
    {
      uint count;
      fixed (SurfaceContact* first = contacts)
        Check(NativeCalls.sunder_find_blade_contacts(SceneNumber, Id, &blade, first, contacts == null ? 0 : (uint)contacts.Length, &count));
      return (int)count;
    }
  }

  /// <summary>A point of tissue that is pulled to a place.</summary>
  public readonly unsafe struct Hold
  {
    readonly Instance instance;
    readonly ulong id;

    internal Hold(Instance instance, ulong id)
    {
      this.instance = instance;
      this.id = id;
    }

    public void Move(Vector3d target) { instance.Check(NativeCalls.sunder_move_hold(instance.SceneNumber, instance.Id, id, &target)); }
    public void Release() { instance.Check(NativeCalls.sunder_release_hold(instance.SceneNumber, instance.Id, id)); }
  }
}
