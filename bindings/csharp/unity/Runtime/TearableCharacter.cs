using System;
using UnityEngine;

namespace Sunder.Unity
{
  /// <summary>What characters that share an asset have in common.</summary>
  struct CharacterSettings : IEquatable<CharacterSettings>
  {
    internal bool IsSkinnedByUnity, IsSoft;
    internal string Tissue;
    internal float Tension;

    public bool Equals(CharacterSettings other)
    {
      return IsSkinnedByUnity == other.IsSkinnedByUnity && IsSoft == other.IsSoft && Tissue == other.Tissue && Tension == other.Tension;
    }
  }

  public enum CharacterSkinning
  {
    /// <summary>The library poses vertices, with all influences, displaced normals and tissue. A MeshRenderer draws them.</summary>
    BySunder,
    /// <summary>Unity poses vertices, also new ones, on the graphics card: at most 4 influences, no tissue.</summary>
    ByUnity
  }

  /// <summary>Makes what a SkinnedMeshRenderer draws tearable. Animations, ragdolls and scripts go on to move its bones. Places are in
  /// world space, in metres.</summary>
  [RequireComponent(typeof(SkinnedMeshRenderer))]
  [DisallowMultipleComponent]
  [AddComponentMenu("Sunder/Tearable Character")]
  public sealed class TearableCharacter : MonoBehaviour
  {
    [Tooltip("Who poses the vertices. By Unity: at most 4 influences per vertex, no tissue.")]
    [SerializeField] CharacterSkinning skinning = CharacterSkinning.BySunder;
    [Tooltip("Material of walls and caps; none: that of the torn surface.")]
    [SerializeField] Material flesh = null;
    [Tooltip("Torn tissue moves by itself. Skinning must be by Sunder.")]
    [SerializeField] bool isSoft = false;
    [Tooltip("skin, fat, muscle, liver, rubber, foam, cloth or jelly")]
    [SerializeField] string tissue = "skin";
    [Tooltip("Pulls lips apart, N/m")]
    [SerializeField] float tension = 0;
    [SerializeField] TornEvent torn = new TornEvent();
    [SerializeField] DetachedEvent detached = new DetachedEvent();
    [SerializeField] FailedEvent failed = new FailedEvent();

    SkinnedMeshRenderer source;
    UnityEngine.Mesh sourceMesh;
    Material[] sourceMaterials;
    Transform[] bones;
    TearScene scene;
    TearScene.SharedAsset shared;
    DrawnMesh drawn;
    GameObject drawnObject;
    MeshRenderer drawnRenderer;
    double[] matrices;
    float[] shapeWeights;

    readonly OwnedStroke stroke = new OwnedStroke();
    Instance instance;
    bool isGone, isListed;

    /// <summary>In the scene of the library, for all that this component has no method for. Its space is model space: ToModel() and
    /// ToWorld(). Made at the first frame, or when it is asked for; null after the component or the scene was destroyed.</summary>
    public Instance Instance
    {
      get
      {
        if (instance == null && !isGone) Enter();
        return instance;
      }
    }

    public TornEvent Torn { get { return torn; } }
    public DetachedEvent Detached { get { return detached; } }
    public FailedEvent Failed { get { return failed; } }

    /// <summary>Skinning, IsSoft and Tissue are set before the first frame.</summary>
    public CharacterSkinning Skinning { get { return skinning; } set { RequireEarly("Skinning"); skinning = value; } }
    public bool IsSoft { get { return isSoft; } set { RequireEarly("IsSoft"); isSoft = value; } }
    public string Tissue { get { return tissue; } set { RequireEarly("Tissue"); tissue = value; } }
    public float Tension { get { return tension; } set { tension = value; if (instance != null && isSoft) instance.SetTension(value); } }
    public Material Flesh { get { return flesh; } set { flesh = value; if (drawn != null) SetMaterials(); } }

    /// <summary>That which is drawn.</summary>
    public UnityEngine.Mesh Mesh { get { return drawn == null ? null : drawn.Mesh; } }
    public Renderer Renderer { get { return drawnRenderer != null ? (Renderer)drawnRenderer : source; } }
    /// <summary>Whether somebody makes a stroke by BeginStroke() now.</summary>
    public bool HasStroke { get { return !stroke.IsFree; } }
    /// <summary>Whether it is updated and drawn.</summary>
    internal bool IsListed { get { return isListed; } }

    void RequireEarly(string field)
    {
      if (instance != null) throw new InvalidOperationException(field + " of " + name + " is set before its first frame");
    }

    // ---- life ----

    void Start()
    {
      if (Instance != null && !isListed) Join();
    }

    void OnEnable()
    {
      if (instance != null && !isListed) Join();
    }

    void OnDisable()
    {
      if (isListed) Part();
    }

    /// <summary>From now on it is updated and drawn.</summary>
    void Join()
    {
      isListed = true;
      scene.Add(this);
      instance.IsVisible = true;
      if (drawnObject == null) return;
      source.enabled = false;
      drawnObject.SetActive(true);
    }

    void Part()
    {
      isListed = false;
      scene.Remove(this);
      if (IsInScene(instance))
      {
        stroke.End(instance);
        instance.IsVisible = false;
      }
      else stroke.Forget();
      if (drawnObject != null) drawnObject.SetActive(false);
    }

    void OnDestroy() { Leave(); }

    void Enter()
    {
      source = GetComponent<SkinnedMeshRenderer>();
      if (isSoft && skinning == CharacterSkinning.ByUnity) throw new InvalidOperationException(name + ": tissue needs skinning by Sunder");
      scene = TearScene.Current;
      Instance made = null;
      shared = scene.Share(source, new CharacterSettings { IsSkinnedByUnity = skinning == CharacterSkinning.ByUnity, IsSoft = isSoft,
        Tissue = isSoft ? tissue : "", Tension = tension });
      try
      {
        sourceMesh = source.sharedMesh;
        sourceMaterials = source.sharedMaterials;
        bones = source.bones;
        matrices = new double[12 * shared.Source.Character.BoneCount];
        shapeWeights = new float[shared.Source.Character.MorphWeightCount];
        made = scene.Scene.Spawn(shared.Asset);
        made.PrepareToTear();
        SendPose(made);
        drawn = new DrawnMesh(shared.Source, skinning == CharacterSkinning.ByUnity, sourceMesh);
        if (skinning == CharacterSkinning.BySunder) MakeRenderer();
      }
      catch
      {
        Discard(made);
        throw;
      }
      instance = made;
      scene.Enter(this, instance.Id);
      if (isActiveAndEnabled) Join();
    }

    /// <summary>Takes back what Enter() has made, or made in part.</summary>
    void Discard(Instance made)
    {
      if (made != null && IsInScene(made)) made.Destroy();
      scene.Release(shared);
      shared = null;
      if (drawnObject != null) Destroy(drawnObject);
      drawnObject = null;
      drawnRenderer = null;
      if (drawn != null) Destroy(drawn.Mesh);
      drawn = null;
    }

    /// <summary>A program may have disposed the library's scene, or destroyed the instance.</summary>
    static bool IsInScene(Instance one) { return !one.Scene.IsDisposed && one.Exists; }

    /// <summary>A transform of its own, without a scale, because model space has none.</summary>
    void MakeRenderer()
    {
      drawnObject = new GameObject(name + " (torn)");
      // Where it stays when another scene is loaded: the character may stay too.
      drawnObject.transform.SetParent(scene.transform, false);
      drawnObject.layer = gameObject.layer;
      drawnObject.AddComponent<MeshFilter>().sharedMesh = drawn.Mesh;
      drawnRenderer = drawnObject.AddComponent<MeshRenderer>();
      drawnRenderer.shadowCastingMode = source.shadowCastingMode;
      drawnRenderer.receiveShadows = source.receiveShadows;
      drawnRenderer.lightProbeUsage = source.lightProbeUsage;
      drawnRenderer.reflectionProbeUsage = source.reflectionProbeUsage;
      // An animator whose renderers are all off would stop.
      Animator animator = GetComponentInParent<Animator>();
      if (animator != null) animator.cullingMode = AnimatorCullingMode.AlwaysAnimate;
    }

    /// <summary>The renderer draws the whole mesh again.</summary>
    internal void Leave()
    {
      isGone = true;
      if (instance == null) return;
      if (isListed) Part();
      scene.Leave(instance.Id);
      Instance left = instance;
      instance = null;
      stroke.Forget();
      if (source != null)
      {
        source.enabled = true;
        source.sharedMesh = sourceMesh;
        source.sharedMaterials = sourceMaterials;
      }
      Discard(left);
    }

    // ---- a frame ----

    internal void SendPose() { SendPose(instance); }

    void SendPose(Instance to)
    {
      shared.Source.ReadPose(transform, bones, matrices);
      if (shapeWeights.Length > 0) shared.Source.ReadShapeWeights(source, shapeWeights);
      to.SetMatrices(matrices, shapeWeights.Length > 0 ? shapeWeights : null);
    }

    internal void Draw()
    {
      if (drawnObject != null) drawnObject.transform.SetPositionAndRotation(transform.position, transform.rotation);
      bool isFirst = drawn.SubmeshOfRange.Length == 0;
      if (!drawn.Follow(instance, sourceMesh) && !isFirst) return;
      if (drawnObject == null && source.sharedMesh != drawn.Mesh) source.sharedMesh = drawn.Mesh;
      SetMaterials();
    }

    /// <summary>One per draw call.</summary>
    void SetMaterials()
    {
      MeshView bind = instance.GetMesh();
      Material[] materials = new Material[drawn.SubmeshOfRange.Length];
      for (int i = 0; i < materials.Length; ++i)
      {
        int submesh = drawn.SubmeshOfRange[i];
        materials[i] = MaterialOf(bind.SubmeshName(submesh), bind.SubmeshMaterial(submesh));
      }
      Renderer.sharedMaterials = materials;
    }

    /// <summary>Of a submesh of the torn mesh or of a piece. Those of walls and caps have other names than those of the source.</summary>
    internal Material MaterialOf(string submesh, uint? material)
    {
      if (flesh != null && !submesh.StartsWith(SkinSource.SubmeshName, StringComparison.Ordinal)) return flesh;
      long slot = material ?? 0;
      return slot < sourceMaterials.Length ? sourceMaterials[slot] : null;
    }

    /// <summary>One that is disabled goes on with what was submitted before, but raises no events.</summary>
    internal void Report(OperationResult result)
    {
      stroke.Hear(instance, result);
      if (!isListed)
      {
        if (result.HasPiece) result.TakePiece().Dispose();
        return;
      }
      if (!result.Succeeded) failed.Invoke(this, result.Error);
      else if (result.HasPiece) detached.Invoke(this, result.TakePiece());
      else if (result.VerticesAdded > 0 || result.TrianglesRetired > 0 || result.TrianglesAdded > 0) torn.Invoke(this, new TearInfo(result));
    }

    // ---- spaces ----

    /// <summary>Model space has the place and rotation of this transform, without its scale, mirrored (Mirror).</summary>
    public Vector3d ToModel(Vector3 world) { return Mirror.ToSunder(Quaternion.Inverse(transform.rotation) * (world - transform.position)); }
    public Vector3 ToWorld(Vector3d model) { return transform.position + transform.rotation * Mirror.ToUnity(model); }
    public Vector3d DirectionToModel(Vector3 world) { return Mirror.ToSunder(Quaternion.Inverse(transform.rotation) * world); }
    public Vector3 DirectionToWorld(Vector3d model) { return transform.rotation * Mirror.ToUnity(model); }

    public BladePosition BladeToModel(Vector3 edgeBase, Vector3 edgeTip)
    {
      BladePosition blade = new BladePosition();
      blade.Base = ToModel(edgeBase);
      blade.Tip = ToModel(edgeTip);
      return blade;
    }

    // ---- strokes over several frames ----

    /// <summary>Begins a stroke, which `owner` alone goes on with and ends: a character has one at a time. Returns false if it has one;
    /// use this instead of Instance.BeginStroke() where blades or other scripts tear too. Options of null: the default.</summary>
    public bool BeginStroke(object owner, BladePosition blade, TearOptions? options = null, StrokeSampling? sampling = null)
    {
      if (owner == null) throw new ArgumentNullException("owner");
      return Instance != null && stroke.Begin(instance, owner, blade, options, sampling);
    }

    /// <summary>seconds: since the last position. Returns false, and does nothing, if the stroke is not the owner's, as after the library
    /// refused it (Failed tells why) or the character was disabled.</summary>
    public bool ExtendStroke(object owner, BladePosition blade, double seconds) { return stroke.Extend(instance, owner, blade, seconds); }

    /// <summary>The same for its end.</summary>
    public bool EndStroke(object owner)
    {
      if (!stroke.IsOf(owner)) return false;
      stroke.End(instance);
      return true;
    }

    // ---- operations: the next frame applies them, in the pose of then ----

    /// <summary>Tears along positions of a blade: `bases` outside the surface, `tips` as deep as it reaches.</summary>
    public Command Tear(Vector3[] bases, Vector3[] tips, TearOptions? options = null)
    {
      if (bases == null || tips == null || bases.Length != tips.Length) throw new ArgumentException("as many bases as tips are needed");
      BladePosition[] blades = new BladePosition[bases.Length];
      for (int i = 0; i < blades.Length; ++i) blades[i] = BladeToModel(bases[i], tips[i]);
      return Instance.Tear(blades, options);
    }

    /// <summary>Cuts by a plane. bone: only what its branch moves.</summary>
    public Command Cut(Vector3 point, Vector3 normal, bool hasCaps = true, Transform bone = null)
    {
      PlaneCut cut = PlaneCut.Default;
      cut.Point = ToModel(point);
      cut.Normal = DirectionToModel(normal);
      cut.HasCaps = hasCaps;
      return Instance.Cut(cut, null, null, NameOf(bone));
    }

    /// <summary>Bores a round hole, with a wall.</summary>
    public Command Drill(Vector3 origin, Vector3 direction, float radius, float depth)
    {
      Bore bore = Bore.Default;
      bore.Origin = ToModel(origin);
      bore.Direction = DirectionToModel(direction);
      bore.Radius = radius;
      bore.Depth = depth;
      bore.HasWall = true;
      return Instance.Drill(bore);
    }

    /// <summary>Takes off the connected piece nearest to a place: Detached gets it.</summary>
    public Command Detach(Vector3 point, Transform bone = null)
    {
      Detachment detachment = Detachment.Default;
      detachment.Point = ToModel(point);
      return Instance.Detach(detachment, NameOf(bone));
    }

    public Command Undo() { return Instance.Undo(); }
    public Command Redo() { return Instance.Redo(); }

    /// <summary>Where a ray first meets the surface as it was drawn last.</summary>
    public bool Raycast(Ray ray, float length, out TearHit hit)
    {
      SurfaceContact contact;
      hit = new TearHit();
      if (!Instance.CastRay(ToModel(ray.origin), DirectionToModel(ray.direction), length, out contact)) return false;
      hit.Point = ToWorld(contact.Place);
      hit.Normal = DirectionToWorld(contact.Normal);
      hit.Distance = (float)contact.Distance;
      hit.Triangle = (int)contact.Triangle;
      hit.Submesh = (int)contact.Submesh;
      if (contact.Bone != Constants.None) hit.Bone = TransformOf((int)contact.Bone);
      return true;
    }

    Transform TransformOf(int bone)
    {
      return shared.Source.SlotOfBone.Length == 0 ? transform : bones[shared.Source.SlotOfBone[bone]];
    }

    string NameOf(Transform bone)
    {
      if (bone == null) return null;
      for (int i = 0; i < shared.Source.Character.BoneCount; ++i)
        if (TransformOf(i) == bone) return shared.Source.Character.GetBone(i).Name;
      throw new ArgumentException(bone.name + " is no bone of " + name, "bone");
    }
  }
}
