using System.Collections.Generic;
using UnityEngine;

namespace Sunder.Unity
{
  /// <summary>An edge that tears the characters that it meets while it moves: a stroke begins where it comes near, goes on from frame to
  /// frame, and ends where it leaves.</summary>
  [DefaultExecutionOrder(29000)]
  [AddComponentMenu("Sunder/Blade")]
  public sealed class Blade : MonoBehaviour
  {
    [Tooltip("End of the edge that stays outside, in the space of this transform")]
    [SerializeField] Vector3 edgeBase = Vector3.zero;
    [Tooltip("End of the edge that goes into the surface")]
    [SerializeField] Vector3 edgeTip = new Vector3(0, 0, 0.5f);
    [Tooltip("Of the gap, metres; 0: the lips coincide")]
    [SerializeField] float width = 0;
    [Tooltip("Of the walls inside the gap, metres; 0: none")]
    [SerializeField] float wallDepth = 0;
    [Tooltip("Tears all layers that the edge crosses, and not only the nearest")]
    [SerializeField] bool tearsAllLayers = false;
    [Tooltip("The edge moves at least as far between two positions of a stroke, metres")]
    [SerializeField] float minimumDistance = 0.005f;

    // Those in which it began a stroke. It is not there any more if the library refused it: another one is tried after the edge left.
    readonly List<TearableCharacter> met = new List<TearableCharacter>();
    Vector3 lastBase, lastTip;
    bool hasLast;

    public Vector3 EdgeBase { get { return edgeBase; } set { edgeBase = value; } }
    public Vector3 EdgeTip { get { return edgeTip; } set { edgeTip = value; } }
    public float Width { get { return width; } set { width = value; } }
    public float WallDepth { get { return wallDepth; } set { wallDepth = value; } }
    public bool TearsAllLayers { get { return tearsAllLayers; } set { tearsAllLayers = value; } }
    public float MinimumDistance { get { return minimumDistance; } set { minimumDistance = value; } }
    /// <summary>Characters in which it makes a stroke now.</summary>
    public int MetCount
    {
      get
      {
        ForgetDisabled();
        return met.Count;
      }
    }

    void LateUpdate() { Move(Time.deltaTime); }

    void OnDisable()
    {
      for (int i = met.Count - 1; i >= 0; --i) Leave(met[i]);
      hasLast = false;
    }

    /// <summary>The edge has come to where the transform is now.</summary>
    public void Move(float seconds)
    {
      ForgetDisabled();
      Vector3 nowBase = transform.TransformPoint(edgeBase), nowTip = transform.TransformPoint(edgeTip);
      if (!hasLast)
      {
        lastBase = nowBase;
        lastTip = nowTip;
        hasLast = true;
        return;
      }
      if (TearScene.Existing != null)
      {
        TearScene scene = TearScene.Existing;
        Bounds swept = new Bounds(nowBase, Vector3.zero);
        swept.Encapsulate(nowTip);
        swept.Encapsulate(lastBase);
        swept.Encapsulate(lastTip);
        for (int i = 0; i < scene.CharacterCount; ++i) Meet(scene.GetCharacter(i), swept, nowBase, nowTip, seconds);
      }
      lastBase = nowBase;
      lastTip = nowTip;
    }

    void Meet(TearableCharacter character, Bounds swept, Vector3 nowBase, Vector3 nowTip, float seconds)
    {
      bool isNear = character.Renderer.bounds.Intersects(swept);
      if (met.Contains(character))
      {
        // Also where it leaves: the last part of its way may be inside.
        character.ExtendStroke(this, character.BladeToModel(nowBase, nowTip), seconds);
        if (!isNear) Leave(character);
      }
      else if (isNear && !character.HasStroke && (nowBase != lastBase || nowTip != lastTip))
      {
        StrokeSampling sampling = StrokeSampling.Default;
        sampling.MinimumDistance = minimumDistance;
        character.BeginStroke(this, character.BladeToModel(lastBase, lastTip), Options(), sampling);
        character.ExtendStroke(this, character.BladeToModel(nowBase, nowTip), seconds);
        met.Add(character);
      }
    }

    /// <summary>A character that is disabled or destroyed ends its stroke by itself.</summary>
    void ForgetDisabled()
    {
      for (int i = met.Count - 1; i >= 0; --i)
        if (met[i] == null || !met[i].IsListed) met.RemoveAt(i);
    }

    TearOptions Options()
    {
      TearOptions options = TearOptions.Default;
      options.Width = width;
      options.WallDepth = wallDepth;
      options.Layers = tearsAllLayers ? TornLayers.All : TornLayers.Nearest;
      return options;
    }

    /// <summary>Ends its stroke in a character.</summary>
    void Leave(TearableCharacter character)
    {
      met.Remove(character);
      character.EndStroke(this);
    }
  }
}
