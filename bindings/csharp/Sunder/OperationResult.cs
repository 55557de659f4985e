using System;
using Sunder.Native;

namespace Sunder
{
  /// <summary>An operation that was submitted. An update applies it.</summary>
  public readonly struct Command
  {
    readonly Scene scene;

    internal Command(Scene scene, ulong id)
    {
      this.scene = scene;
      Id = id;
    }

    /// <summary>Ascending from 0 in the order in which commands are submitted to a scene.</summary>
    public ulong Id { get; }

    /// <summary>The outcome, if the last update applied it.</summary>
    public bool TryGetResult(out OperationResult result) { return scene.TryGetResult(Id, out result); }

    /// <summary>The outcome in the last update. Throws SunderException if the operation failed, which changed nothing.</summary>
    public OperationResult Result
    {
      get
      {
        OperationResult result;
        if (!TryGetResult(out result)) throw new InvalidOperationException("the last update did not apply this operation");
        result.Check();
        return result;
      }
    }
  }

  /// <summary>The outcome of a command in the last update; its text and piece can be asked for until the next one.</summary>
  public readonly unsafe struct OperationResult
  {
    readonly Result raw;
    readonly Scene scene;
    readonly int version;

    internal OperationResult(Result raw, Scene scene, int version)
    {
      this.raw = raw;
      this.scene = scene;
      this.version = version;
    }

    public ulong Command { get { return raw.Command; } }
    /// <summary>The number of the instance.</summary>
    public ulong InstanceId { get { return raw.Instance; } }
    public Status Status { get { return raw.Status; } }
    public bool Succeeded { get { return raw.Status == Status.Ok; } }
    /// <summary>What is wrong; "" if it succeeded.</summary>
    public string Error
    {
      get
      {
        scene.CheckResults(version);
        string error = Utf8.Read(raw.Error);
        GC.KeepAlive(scene);
        return error;
      }
    }
    public uint? ErrorIndex { get { return raw.ErrorIndex == Constants.None ? (uint?)null : raw.ErrorIndex; } }
    /// <summary>Of torn surface; 0: it missed.</summary>
    public int Runs { get { return (int)raw.Runs; } }
    /// <summary>Segments of the stroke that met no surface within the blade's reach.</summary>
    public int SegmentsMissed { get { return (int)raw.SegmentsMissed; } }
    public int FacesCrossed { get { return (int)raw.FacesCrossed; } }
    public int VerticesAdded { get { return (int)raw.VerticesAdded; } }
    public int TrianglesAdded { get { return (int)raw.TrianglesAdded; } }
    public int TrianglesRetired { get { return (int)raw.TrianglesRetired; } }
    /// <summary>Places where the surface could not be torn.</summary>
    public int Blocked { get { return (int)raw.Blocked; } }
    public int Caps { get { return (int)raw.Caps; } }
    /// <summary>Rims that got no cap or wall.</summary>
    public int OpenSections { get { return (int)raw.OpenSections; } }
    /// <summary>Parts that hang together with nothing else now.</summary>
    public int SeparatedPieces { get { return (int)raw.SeparatedPieces; } }
    /// <summary>Of the tear on the posed surface, metres.</summary>
    public double Length { get { return raw.Length; } }
    /// <summary>By a gap or bore.</summary>
    public double AreaRemoved { get { return raw.AreaRemoved; } }
    public bool HasPiece { get { return raw.HasPiece; } }

    /// <summary>The piece of a detachment. Once.</summary>
    public Piece TakePiece()
    {
      scene.CheckResults(version);
      uint piece;
      SunderException.Check(NativeCalls.sunder_take_piece(scene.Number, raw.Command, &piece));
      GC.KeepAlive(scene);
      return new Piece(piece);
    }

    /// <summary>Throws SunderException if the operation failed.</summary>
    public void Check()
    {
      if (!Succeeded) throw new SunderException(raw.Status, Error, raw.ErrorIndex);
    }
  }
}
