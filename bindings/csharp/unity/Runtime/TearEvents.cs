using System;
using UnityEngine;
using UnityEngine.Events;

namespace Sunder.Unity
{
  /// <summary>What an operation did to a character.</summary>
  public struct TearInfo
  {
    public ulong Command;
    public int FacesCrossed, VerticesAdded, TrianglesAdded, SeparatedPieces;
    /// <summary>Of the tear on the posed surface, metres.</summary>
    public float Length;

    internal TearInfo(OperationResult result)
    {
      Command = result.Command;
      FacesCrossed = result.FacesCrossed;
      VerticesAdded = result.VerticesAdded;
      TrianglesAdded = result.TrianglesAdded;
      SeparatedPieces = result.SeparatedPieces;
      Length = (float)result.Length;
    }
  }

  /// <summary>The surface of a character was changed.</summary>
  [Serializable]
  public sealed class TornEvent : UnityEvent<TearableCharacter, TearInfo> { }

  /// <summary>A piece came off. Who listens makes a PieceBody of it, or disposes it; what nobody took is left to the garbage collector.</summary>
  [Serializable]
  public sealed class DetachedEvent : UnityEvent<TearableCharacter, Piece> { }

  /// <summary>An operation failed, and changed nothing: the command and a text.</summary>
  [Serializable]
  public sealed class FailedEvent : UnityEvent<TearableCharacter, string> { }

  /// <summary>Where a ray meets a character, in world space.</summary>
  public struct TearHit
  {
    public Vector3 Point, Normal;
    public float Distance;
    public int Triangle, Submesh;
    /// <summary>That moves the place most; null: none.</summary>
    public Transform Bone;
  }
}
