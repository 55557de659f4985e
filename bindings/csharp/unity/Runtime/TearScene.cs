using System;
using System.Collections.Generic;
using UnityEngine;

namespace Sunder.Unity
{
  /// <summary>Updates all tearable characters once per frame, after animations and scripts. It makes itself when the first character
  /// is enabled.</summary>
  [DefaultExecutionOrder(30000)]
  [AddComponentMenu("")]
  public sealed class TearScene : MonoBehaviour
  {
    static TearScene current;

    /// <summary>Those that are updated and drawn.</summary>
    readonly List<TearableCharacter> characters = new List<TearableCharacter>();
    /// <summary>All that have an instance, also those that are disabled.</summary>
    readonly Dictionary<ulong, TearableCharacter> byInstance = new Dictionary<ulong, TearableCharacter>();
    readonly List<SharedAsset> assets = new List<SharedAsset>();
    Scene scene;

    internal sealed class SharedAsset
    {
      internal UnityEngine.Mesh Mesh;
      internal CharacterSettings Settings;
      internal SkinSource Source;
      internal CharacterAsset Asset;
      internal int Users;
    }

    /// <summary>That of the running game.</summary>
    public static TearScene Current
    {
      get
      {
        if (current == null)
        {
          GameObject made = new GameObject("Sunder");
          DontDestroyOnLoad(made);
          current = made.AddComponent<TearScene>();
        }
        return current;
      }
    }

    /// <summary>Null if no character was enabled yet.</summary>
    internal static TearScene Existing { get { return current; } }

    /// <summary>The scene of the library, for all that the components have no field for.</summary>
    public Scene Scene
    {
      get
      {
        if (scene == null) scene = new Scene();
        return scene;
      }
    }

    public int CharacterCount { get { return characters.Count; } }
    public TearableCharacter GetCharacter(int index) { return characters[index]; }

    internal SharedAsset Share(SkinnedMeshRenderer renderer, CharacterSettings settings)
    {
      foreach (SharedAsset one in assets)
      {
        if (one.Mesh != renderer.sharedMesh || !one.Settings.Equals(settings) || !one.Source.Fits(renderer)) continue;
        ++one.Users;
        return one;
      }
      SkinSource source = new SkinSource(renderer, settings.IsSkinnedByUnity ? 4 : 0);
      AssetOptions options = AssetOptions.Default;
      options.PosesVertices = !settings.IsSkinnedByUnity;
      options.HasNormals = source.HasNormals;
      options.HasTangents = source.HasTangents;
      options.UnitLength = true;
      if (settings.IsSkinnedByUnity) options.MaximumInfluences = 4;
      options.IsSoft = settings.IsSoft;
      options.Tension = settings.Tension;
      SharedAsset made = new SharedAsset { Mesh = renderer.sharedMesh, Settings = settings, Source = source, Users = 1 };
      made.Asset = new CharacterAsset(source.Character, options, settings.IsSoft ? new[] { Tissue.Find(settings.Tissue) } : null);
      assets.Add(made);
      return made;
    }

    internal void Release(SharedAsset asset)
    {
      if (--asset.Users > 0) return;
      assets.Remove(asset);
      asset.Asset.Dispose();
      asset.Source.Character.Dispose();
    }

    internal void Enter(TearableCharacter character, ulong instance) { byInstance.Add(instance, character); }
    internal void Leave(ulong instance) { byInstance.Remove(instance); }
    internal void Add(TearableCharacter character) { characters.Add(character); }
    internal void Remove(TearableCharacter character) { characters.Remove(character); }

    void LateUpdate() { Step(Time.deltaTime); }

    /// <summary>A frame: poses are read, operations applied, meshes uploaded, and events raised.</summary>
    public void Step(float seconds)
    {
      if (characters.Count == 0) return;
      SendPoses();
      Scene.Update(seconds);
      Draw();
      // Whoever listens may destroy characters and submit operations, but results stay until the next update.
      for (int i = 0; i < scene.ResultCount; ++i)
      {
        OperationResult result = scene.GetResult(i);
        TearableCharacter character;
        if (byInstance.TryGetValue(result.InstanceId, out character)) Report(character, result);
        else if (result.HasPiece) result.TakePiece().Dispose();
      }
    }

    /// <summary>A character whose pose cannot be read, as when a bone was destroyed, is disabled; the others go on.</summary>
    void SendPoses()
    {
      for (int i = characters.Count - 1; i >= 0; --i)
      {
        TearableCharacter one = characters[i];
        try
        {
          one.SendPose();
        }
        catch (Exception exception)
        {
          Debug.LogException(exception, one);
          one.enabled = false;
        }
      }
    }

    /// <summary>The same for one that cannot be drawn.</summary>
    void Draw()
    {
      for (int i = characters.Count - 1; i >= 0; --i)
      {
        TearableCharacter one = characters[i];
        try
        {
          one.Draw();
        }
        catch (Exception exception)
        {
          Debug.LogException(exception, one);
          one.enabled = false;
        }
      }
    }

    /// <summary>What a listener throws keeps no event from the others.</summary>
    static void Report(TearableCharacter character, OperationResult result)
    {
      try
      {
        character.Report(result);
      }
      catch (Exception exception)
      {
        Debug.LogException(exception, character);
      }
    }

    void OnDestroy()
    {
      foreach (TearableCharacter one in new List<TearableCharacter>(byInstance.Values)) one.Leave();
      if (scene != null) scene.Dispose();
      scene = null;
      if (current == this) current = null;
    }
  }
}
