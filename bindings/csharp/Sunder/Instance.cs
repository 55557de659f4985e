using System;
using Sunder.Native;

namespace Sunder
{
  /// <summary>A character in a scene; made by Scene.Spawn(). Places are in model space, in metres.</summary>
  public sealed unsafe partial class Instance
  {
    internal Instance(Scene scene, ulong id, CharacterAsset asset)
    {
      Scene = scene;
      Id = id;
      Asset = asset;
    }

    public Scene Scene { get; private set; }
    /// <summary>Never that of another instance of its scene.</summary>
    public ulong Id { get; private set; }
    public CharacterAsset Asset { get; private set; }

    internal uint SceneNumber { get { return Scene.Number; } }

    /// <summary>Throws what failed, and keeps the scene until here.</summary>
    internal void Check(Status status)
    {
      GC.KeepAlive(Scene);
      SunderException.Check(status);
    }

    /// <summary>The same after a call that changes what views show.</summary>
    void Changed(Status status)
    {
      Scene.Change();
      Check(status);
    }

    public bool Exists
    {
      get
      {
        uint exists;
        Check(NativeCalls.sunder_has_instance(SceneNumber, Id, &exists));
        return exists != 0;
      }
    }

    /// <summary>Takes it out of the scene.</summary>
    public void Destroy()
    {
      Changed(NativeCalls.sunder_destroy_instance(SceneNumber, Id));
      Scene.Forget(Id);
    }

    public bool IsVisible { set { Check(NativeCalls.sunder_set_visible(SceneNumber, Id, value ? 1u : 0u)); } }

    /// <summary>Pixels: far instances are updated less often and show the coarser level.</summary>
    public double ScreenHeight { set { Check(NativeCalls.sunder_set_screen_height(SceneNumber, Id, value)); } }

    /// <summary>0: the asset of the instance, 1: its coarser level ...</summary>
    public int ShownLevel
    {
      get
      {
        uint level;
        Check(NativeCalls.sunder_get_shown_level(SceneNumber, Id, &level));
        return (int)level;
      }
    }

    // ---- The pose ----

    /// <summary>Plays a clip of the character.</summary>
    public Layer Play(int clip, LayerOptions? options = null)
    {
      LayerOptions chosen = options ?? LayerOptions.Default;
      ulong layer;
      Check(NativeCalls.sunder_play(SceneNumber, Id, (uint)clip, &chosen, &layer));
      return new Layer(this, layer);
    }

    public Layer Play(string clip, LayerOptions? options = null) { return Play(Asset.Character.FindClip(clip), options); }

    /// <summary>Plays a clip that fades in over all others (options.FadeIn) and then ends them.</summary>
    public Layer CrossFade(int clip, LayerOptions? options = null)
    {
      LayerOptions chosen = options ?? LayerOptions.Default;
      ulong layer;
      Check(NativeCalls.sunder_cross_fade(SceneNumber, Id, (uint)clip, &chosen, &layer));
      return new Layer(this, layer);
    }

    /// <summary>Ends all that plays and holds the present pose.</summary>
    public void Stop() { Check(NativeCalls.sunder_stop(SceneNumber, Id)); }

    /// <summary>The pose of the next update, which ends what plays: model_from_bone, 12 numbers per bone, column after column.</summary>
    public void SetMatrices(double[] modelFromBone, float[] morphWeights = null)
    {
      Library.CheckLength(modelFromBone, 12L * Asset.Character.BoneCount, "modelFromBone");
      CheckMorphWeights(morphWeights);
      fixed (double* matrices = modelFromBone)
      fixed (float* weights = morphWeights)
        Check(NativeCalls.sunder_set_matrices(SceneNumber, Id, matrices, (uint)Asset.Character.BoneCount, weights));
    }

    /// <summary>The pose of the next update, which ends what plays: one transform per bone, each relative to its parent.</summary>
    public void SetTransforms(BoneTransform[] transforms, float[] morphWeights = null)
    {
      Library.CheckLength(transforms, Asset.Character.BoneCount, "transforms");
      CheckMorphWeights(morphWeights);
      fixed (BoneTransform* first = transforms)
      fixed (float* weights = morphWeights)
        Check(NativeCalls.sunder_set_transforms(SceneNumber, Id, first, (uint)transforms.Length, weights));
    }

    void CheckMorphWeights(float[] morphWeights)
    {
      if (morphWeights != null) Library.CheckLength(morphWeights, Asset.Character.MorphWeightCount, "morphWeights");
    }

    /// <summary>The pose of the last update: 12 numbers per bone.</summary>
    public DoubleView Matrices
    {
      get
      {
        double* matrices;
        uint bones;
        Check(NativeCalls.sunder_get_pose(SceneNumber, Id, &matrices, &bones));
        return new DoubleView(matrices, 12ul * bones, Scene.Drawing.Now);
      }
    }

    // ---- Meshes ----

    /// <summary>seen: the epoch up to which the caller's buffers are up to date; 0: there are none yet. O(changes since then).</summary>
    public PosedMesh GetPosedMesh(int mesh = 0, ulong seen = 0)
    {
      Native.PosedMesh posed = Native.PosedMesh.Sized;
      Check(NativeCalls.sunder_get_posed_mesh(SceneNumber, Id, (uint)mesh, seen, &posed));
      return new PosedMesh(posed, Scene.Drawing.Now);
    }

    /// <summary>The torn mesh in bind space, with all attributes and weights.</summary>
    public MeshView GetMesh(int mesh = 0)
    {
      Native.Mesh view;
      Scene.MeshTables.Advance();
      Check(NativeCalls.sunder_get_instance_mesh(SceneNumber, Id, (uint)mesh, &view));
      return new MeshView(view, Scene.Drawing, Scene.MeshTables);
    }

    /// <summary>Vertices are posed into memory of the caller, which stays until another is set, or the instance is destroyed.</summary>
    public void SetVertexTarget(int mesh, VertexTarget target) { Changed(NativeCalls.sunder_set_vertex_target(SceneNumber, Id, (uint)mesh, &target)); }

    /// <summary>Where the vertices from `first` on come from, which is at least the source's vertex count. Needs PrepareToTear() or an
    /// operation before, as the next.</summary>
    public VertexOrigin[] GetVertexOrigins(int mesh, int first)
    {
      uint count;
      Check(NativeCalls.sunder_get_vertex_origins(SceneNumber, Id, (uint)mesh, (uint)first, null, 0, &count));
      VertexOrigin[] origins = new VertexOrigin[count];
      fixed (VertexOrigin* to = origins) Check(NativeCalls.sunder_get_vertex_origins(SceneNumber, Id, (uint)mesh, (uint)first, to, count, &count));
      return origins;
    }

    /// <summary>Where the triangles from `first` on come from, and which points of the surface they have.</summary>
    public TriangleOrigin[] GetTriangleOrigins(int mesh, int first = 0)
    {
      uint count;
      Check(NativeCalls.sunder_get_triangle_origins(SceneNumber, Id, (uint)mesh, (uint)first, null, 0, &count));
      TriangleOrigin[] origins = new TriangleOrigin[count];
      fixed (TriangleOrigin* to = origins) Check(NativeCalls.sunder_get_triangle_origins(SceneNumber, Id, (uint)mesh, (uint)first, to, count, &count));
      return origins;
    }

    /// <summary>Keeps the wounds of a mesh in its texture from now on.</summary>
    public void BeginWoundMask(int mesh = 0, WoundMaskOptions? options = null)
    {
      WoundMaskOptions chosen = options ?? WoundMaskOptions.Default;
      Changed(NativeCalls.sunder_begin_wound_mask(SceneNumber, Id, (uint)mesh, &chosen));
    }

    /// <summary>The wounds in the texture, and the rectangle that changed since the last call.</summary>
    public WoundMask GetWoundMask(int mesh = 0)
    {
      Native.WoundMask mask = Native.WoundMask.Sized;
      Check(NativeCalls.sunder_get_wound_mask(SceneNumber, Id, (uint)mesh, &mask));
      return new WoundMask(mask, Scene.Drawing.Now);
    }

    /// <summary>A number per texel of the wound mask, copied, in the order of its distances. The stretch is of the vertices of the last
    /// update.</summary>
    public float[] GetWoundChannel(WoundChannel channel, int mesh = 0)
    {
      float* texels;
      uint count;
      Check(NativeCalls.sunder_get_wound_channel(SceneNumber, Id, (uint)mesh, (uint)channel, &texels, &count));
      return new FloatView(texels, count, Scene.Drawing.Now).ToArray();
    }

    /// <summary>Lets blood run down from the lips in the pose of the last update: how much of it is on each texel of the wound mask, 0 to
    /// 1, copied.</summary>
    public float[] FlowBlood(int mesh = 0, BloodFlowOptions? options = null)
    {
      BloodFlowOptions chosen = options ?? BloodFlowOptions.Default;
      float* texels;
      uint count;
      Check(NativeCalls.sunder_flow_blood(SceneNumber, Id, (uint)mesh, &chosen, &texels, &count));
      return new FloatView(texels, count, Scene.Drawing.Now).ToArray();
    }

    public void EndWoundMask(int mesh = 0) { Changed(NativeCalls.sunder_end_wound_mask(SceneNumber, Id, (uint)mesh)); }

    /// <summary>The torn character as a file: the source document with the meshes that were torn.</summary>
    public byte[] ToGlb(SaveOptions? options = null)
    {
      SaveOptions chosen = options ?? SaveOptions.Default;
      uint bytes;
      Check(NativeCalls.sunder_save_instance(SceneNumber, Id, &chosen, &bytes));
      return Library.Take(bytes);
    }

    /// <summary>How the torn skin deforms beside that of the character, and what the newest operation did to it.</summary>
    public ValidationReport Validate(ValidationOptions? options = null)
    {
      ValidationOptions chosen = options ?? ValidationOptions.Default;
      uint report;
      Check(NativeCalls.sunder_validate_instance(SceneNumber, Id, &chosen, &report));
      return new ValidationReport(report);
    }
  }

  /// <summary>A clip that an instance plays.</summary>
  public readonly unsafe struct Layer
  {
    readonly Instance instance;
    readonly ulong id;

    internal Layer(Instance instance, ulong id)
    {
      this.instance = instance;
      this.id = id;
    }

    public void Seek(double time) { instance.Check(NativeCalls.sunder_seek_layer(instance.SceneNumber, instance.Id, id, time)); }
    public void SetSpeed(double speed) { instance.Check(NativeCalls.sunder_set_layer_speed(instance.SceneNumber, instance.Id, id, speed)); }
    public void Fade(float weight, double seconds) { instance.Check(NativeCalls.sunder_fade_layer(instance.SceneNumber, instance.Id, id, weight, seconds)); }
    /// <summary>Fades it out and ends it.</summary>
    public void Stop(double seconds = 0) { instance.Check(NativeCalls.sunder_stop_layer(instance.SceneNumber, instance.Id, id, seconds)); }

    public LayerState State
    {
      get
      {
        LayerState state = LayerState.Sized;
        instance.Check(NativeCalls.sunder_get_layer(instance.SceneNumber, instance.Id, id, &state));
        return state;
      }
    }
  }

  /// <summary>Distances per texel, row by row from the top: metres along the surface from the nearest lip, at most the reach; negative
  /// where operations removed the skin.</summary>
  public readonly unsafe struct WoundMask
  {
    readonly Native.WoundMask raw;
    readonly Moment moment;

    internal WoundMask(Native.WoundMask raw, Moment moment)
    {
      this.raw = raw;
      this.moment = moment;
    }

    public int Width { get { return (int)raw.Width; } }
    public int Height { get { return (int)raw.Height; } }
    /// <summary>The texels that may have changed since the last call; none: ChangedWidth 0.</summary>
    public int Left { get { return (int)raw.Left; } }
    public int Top { get { return (int)raw.Top; } }
    public int ChangedWidth { get { return (int)raw.ChangedWidth; } }
    public int ChangedHeight { get { return (int)raw.ChangedHeight; } }
    /// <summary>Of mirrored or stacked charts.</summary>
    public int OverlappingTexels { get { return (int)raw.OverlappingTexels; } }
    /// <summary>Without area in the texture, or wider than it.</summary>
    public int UnpaintedTriangles { get { return (int)raw.UnpaintedTriangles; } }
    public FloatView Distances { get { return new FloatView(raw.Distances, (ulong)raw.Width * raw.Height, moment); } }
  }
}
