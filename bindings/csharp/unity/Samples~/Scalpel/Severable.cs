using Sunder;
using Sunder.Unity;
using UnityEngine;

/// <summary>Sever() cuts through at a bone, and what comes off falls as a rigid body.</summary>
[RequireComponent(typeof(TearableCharacter))]
public sealed class Severable : MonoBehaviour
{
  TearableCharacter character;
  Transform bone;
  ulong command;
  bool isCutting;

  void Start()
  {
    character = GetComponent<TearableCharacter>();
    character.Torn.AddListener(OnTorn);
    character.Detached.AddListener((who, piece) => PieceBody.Make(who, piece));
  }

  /// <summary>The plane goes through the bone's origin, across it; only what the bone's branch moves is cut.</summary>
  public void Sever(Transform at)
  {
    bone = at;
    command = character.Cut(at.position, at.up, true, at).Id;
    isCutting = true;
  }

  void OnTorn(TearableCharacter who, TearInfo info)
  {
    if (!isCutting || info.Command != command) return;
    isCutting = false;
    if (info.SeparatedPieces > 0) character.Detach(bone.position + 0.1f * bone.up, bone);
  }
}
