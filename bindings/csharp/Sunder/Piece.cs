using System;
using Sunder.Native;

namespace Sunder
{
  /// <summary>A convex part of a piece, copied. Points are 3 numbers each, in the frame of the piece; triangles 3 indices each.</summary>
  public struct ConvexHull
  {
    public double[] Points;
    public uint[] Triangles;
    /// <summary>Whose part it is, or null.</summary>
    public uint? Bone;
    public double Volume;
  }

  /// <summary>A part that came off: a character of its own, with mass and inertia.</summary>
  public sealed unsafe class Piece : IDisposable
  {
    readonly PieceHandle handle;
    readonly Epoch epoch;

    internal Piece(uint number)
    {
      handle = new PieceHandle(number);
      epoch = new Epoch(handle, "");
    }

    internal uint Number { get { return handle.Number; } }

    public PieceInfo Info
    {
      get
      {
        PieceInfo info = PieceInfo.Sized;
        SunderException.Check(NativeCalls.sunder_get_piece(Number, &info));
        GC.KeepAlive(this);
        return info;
      }
    }

    /// <summary>The piece as a character, for an asset of its own.</summary>
    public Character ToCharacter()
    {
      uint character;
      SunderException.Check(NativeCalls.sunder_get_piece_character(Number, &character));
      GC.KeepAlive(this);
      return new Character(character);
    }

    /// <summary>For each vertex of a mesh of the piece: the vertex of the torn mesh that it was.</summary>
    public UIntView GetTornVertices(int mesh, out int tornMesh)
    {
      uint from, count;
      uint* vertices;
      SunderException.Check(NativeCalls.sunder_get_piece_vertices(Number, (uint)mesh, &from, &vertices, &count));
      GC.KeepAlive(this);
      tornMesh = (int)from;
      return new UIntView(vertices, count, epoch.Now);
    }

    /// <summary>Convex hulls of a frozen piece for a physics engine.</summary>
    public ConvexHull[] GetHulls(int mostHulls, int mostPoints)
    {
      Hull* hulls;
      uint count;
      SunderException.Check(NativeCalls.sunder_get_piece_hulls(Number, (uint)mostHulls, (uint)mostPoints, &hulls, &count));
      ConvexHull[] copies = new ConvexHull[count];
      for (int i = 0; i < copies.Length; ++i)
      {
        copies[i].Points = new DoubleView(hulls[i].Points, 3ul * hulls[i].PointCount, epoch.Now).ToArray();
        copies[i].Triangles = new UIntView(hulls[i].Triangles, 3ul * hulls[i].TriangleCount, epoch.Now).ToArray();
        copies[i].Bone = hulls[i].Bone == Constants.None ? (uint?)null : hulls[i].Bone;
        copies[i].Volume = hulls[i].Volume;
      }
      GC.KeepAlive(this);
      return copies;
    }

    public void Dispose() { handle.Dispose(); }
  }
}
