using System;
using System.Collections.Generic;
using System.Reflection;

namespace UnityEngine
{
  [AttributeUsage(AttributeTargets.Field)] public sealed class SerializeFieldAttribute : Attribute { }
  [AttributeUsage(AttributeTargets.Field)] public sealed class TooltipAttribute : Attribute { public TooltipAttribute(string text) { } }
  [AttributeUsage(AttributeTargets.Class)] public sealed class DefaultExecutionOrder : Attribute
  {
    public int order { get; private set; }
    public DefaultExecutionOrder(int order) { this.order = order; }
  }
  [AttributeUsage(AttributeTargets.Class)] public sealed class AddComponentMenu : Attribute { public AddComponentMenu(string menu) { } }
  [AttributeUsage(AttributeTargets.Class)] public sealed class RequireComponent : Attribute { public RequireComponent(Type type) { } }
  [AttributeUsage(AttributeTargets.Class)] public sealed class DisallowMultipleComponent : Attribute { }

  public static class Time { public static float deltaTime = 1f / 60; }
  public static class Debug
  {
    public static string Logged = "";
    public static void Log(object message) { Logged += message + "\n"; }
    public static void LogException(Exception exception, Object context) { Logged += context.GetType().Name + ": " + exception.Message + "\n"; }
  }

  public sealed class MissingReferenceException : Exception { public MissingReferenceException(string text) : base(text) { } }

  public class Object
  {
    bool isDestroyed;
    public string name { get; set; }

    /// <summary>As in Unity, one that was destroyed equals null.</summary>
    public static bool operator ==(Object a, Object b)
    {
      bool noA = ReferenceEquals(a, null) || a.isDestroyed, noB = ReferenceEquals(b, null) || b.isDestroyed;
      return noA || noB ? noA && noB : ReferenceEquals(a, b);
    }
    public static bool operator !=(Object a, Object b) { return !(a == b); }
    public override bool Equals(object other) { return this == (other as Object); }
    public override int GetHashCode() { return base.GetHashCode(); }

    public static void DontDestroyOnLoad(Object one) { }

    /// <summary>At once, and not at the end of the frame.</summary>
    public static void Destroy(Object one)
    {
      if (one == null) return;
      one.WhenDestroyed();
      one.isDestroyed = true;
    }
    protected virtual void WhenDestroyed() { }
  }

  public class Component : Object
  {
    public GameObject gameObject { get; internal set; }
    public Transform transform
    {
      get
      {
        if (this == null) throw new MissingReferenceException("an object that was destroyed is used");
        return gameObject.transform;
      }
    }
    public new string name { get { return gameObject.name; } }
    public T GetComponent<T>() where T : Component { return gameObject.GetComponent<T>(); }
    public T GetComponentInParent<T>() where T : Component
    {
      for (Transform t = transform; t != null; t = t.parent)
        if (t.gameObject.GetComponent<T>() != null) return t.gameObject.GetComponent<T>();
      return null;
    }
  }

  public class Behaviour : Component
  {
    bool isEnabled = true;
    internal bool HasStarted;
    public bool isActiveAndEnabled { get { return isEnabled && gameObject.activeSelf; } }
    public bool enabled
    {
      get { return isEnabled; }
      set
      {
        if (isEnabled == value) return;
        isEnabled = value;
        if (gameObject.activeSelf) Send(value ? "OnEnable" : "OnDisable");
      }
    }

    internal void Send(string message)
    {
      MethodInfo method = GetType().GetMethod(message, BindingFlags.Instance | BindingFlags.NonPublic | BindingFlags.Public);
      if (method == null) return;
      try
      {
        method.Invoke(this, null);
      }
      catch (TargetInvocationException exception)
      {
        System.Runtime.ExceptionServices.ExceptionDispatchInfo.Capture(exception.InnerException).Throw();
      }
    }

    protected override void WhenDestroyed()
    {
      if (isEnabled && gameObject.activeSelf) Send("OnDisable");
      Send("OnDestroy");
    }
  }

  public class MonoBehaviour : Behaviour { }

  public sealed class GameObject : Object
  {
    internal readonly List<Component> Components = new List<Component>();
    public Transform transform { get; private set; }
    public int layer { get; set; }
    public bool activeSelf { get; private set; }

    public GameObject(string name)
    {
      this.name = name;
      activeSelf = true;
      transform = AddComponent<Transform>();
      Host.All.Add(this);
    }

    public T AddComponent<T>() where T : Component, new()
    {
      T one = new T();
      one.gameObject = this;
      Components.Add(one);
      if (activeSelf && one is MonoBehaviour) ((Behaviour)(Component)one).Send("OnEnable");
      return one;
    }

    public T GetComponent<T>() where T : Component
    {
      foreach (Component one in Components)
        if (one is T && one != null) return (T)one;
      return null;
    }

    public void SetActive(bool active)
    {
      if (activeSelf == active) return;
      activeSelf = active;
      foreach (Component one in Components.ToArray())
        if (one is MonoBehaviour && one != null && ((Behaviour)one).enabled) ((Behaviour)one).Send(active ? "OnEnable" : "OnDisable");
    }

    protected override void WhenDestroyed()
    {
      foreach (Component one in Components.ToArray()) Destroy(one);
      Host.All.Remove(this);
    }
  }

  /// <summary>What runs the game: a frame sends Start, Update and LateUpdate in the order that scripts ask for.</summary>
  public static class Host
  {
    internal static readonly List<GameObject> All = new List<GameObject>();
    public static int Count { get { return All.Count; } }

    public static void Frame()
    {
      foreach (MonoBehaviour script in Scripts())
      {
        if (script == null || script.HasStarted) continue;
        script.HasStarted = true;
        script.Send("Start");
      }
      foreach (string message in new[] { "Update", "LateUpdate" })
        foreach (MonoBehaviour script in Scripts())
          if (script != null) script.Send(message);
    }

    static List<MonoBehaviour> Scripts()
    {
      List<MonoBehaviour> scripts = new List<MonoBehaviour>();
      foreach (GameObject one in All)
        foreach (Component component in one.Components)
        {
          MonoBehaviour script = component as MonoBehaviour;
          if (one.activeSelf && script != null && script.enabled) scripts.Add(script);
        }
      scripts.Sort((a, b) => OrderOf(a).CompareTo(OrderOf(b)));
      return scripts;
    }

    static int OrderOf(MonoBehaviour script)
    {
      object[] orders = script.GetType().GetCustomAttributes(typeof(DefaultExecutionOrder), false);
      return orders.Length == 0 ? 0 : ((DefaultExecutionOrder)orders[0]).order;
    }
  }

  public sealed class Transform : Component
  {
    public Transform parent { get; set; }
    public Vector3 localPosition = Vector3.zero;
    public Quaternion localRotation = Quaternion.identity;
    public Vector3 localScale = Vector3.one;

    public Matrix4x4 localToWorldMatrix
    {
      get
      {
        if (this == null) throw new MissingReferenceException("a transform that was destroyed is used");
        Matrix4x4 local = Matrix4x4.TRS(localPosition, localRotation, localScale);
        return parent == null ? local : parent.localToWorldMatrix * local;
      }
    }
    public Matrix4x4 worldToLocalMatrix { get { return localToWorldMatrix.inverse; } }
    public Vector3 up { get { return rotation * new Vector3(0, 1, 0); } }
    public Vector3 position { get { return parent == null ? localPosition : parent.localToWorldMatrix.MultiplyPoint3x4(localPosition); } }
    public Quaternion rotation { get { return parent == null ? localRotation : parent.rotation * localRotation; } }
    public Vector3 TransformPoint(Vector3 p) { return localToWorldMatrix.MultiplyPoint3x4(p); }
    public void SetParent(Transform to, bool worldPositionStays)
    {
      if (worldPositionStays) throw new NotSupportedException();
      parent = to;
    }
    public void SetPositionAndRotation(Vector3 p, Quaternion r)
    {
      localPosition = parent == null ? p : parent.worldToLocalMatrix.MultiplyPoint3x4(p);
      localRotation = parent == null ? r : Quaternion.Inverse(parent.rotation) * r;
    }
  }

  public sealed class Material : Object { public Material(string name) { this.name = name; } }
  public enum AnimatorCullingMode { AlwaysAnimate, CullUpdateTransforms, CullCompletely }
  public sealed class Animator : Behaviour { public AnimatorCullingMode cullingMode { get; set; } }

  public sealed class Camera : Behaviour
  {
    public static Camera main { get; set; }
    /// <summary>Along the camera's axis, wherever the mouse is.</summary>
    public Ray ScreenPointToRay(Vector3 screen) { return new Ray(transform.position, transform.rotation * new Vector3(0, 0, 1)); }
  }

  public static class Input
  {
    public static Vector3 mousePosition { get; set; }
    public static bool IsPressed;
    public static bool GetMouseButton(int button) { return IsPressed; }
  }

  public class Renderer : Component
  {
    Material[] materials = new Material[0];
    public bool enabled { get; set; }
    public Material[] sharedMaterials { get { return (Material[])materials.Clone(); } set { materials = (Material[])value.Clone(); } }
    public Rendering.ShadowCastingMode shadowCastingMode { get; set; }
    public bool receiveShadows { get; set; }
    public Rendering.LightProbeUsage lightProbeUsage { get; set; }
    public Rendering.ReflectionProbeUsage reflectionProbeUsage { get; set; }
    public Renderer() { enabled = true; }

    protected virtual Bounds LocalBounds { get { return GetComponent<MeshFilter>().sharedMesh.bounds; } }
    public Bounds bounds
    {
      get
      {
        Bounds local = LocalBounds, world = new Bounds();
        for (int i = 0; i < 8; ++i)
        {
          Vector3 e = local.extents, corner = local.center + new Vector3((i & 1) != 0 ? e.x : -e.x, (i & 2) != 0 ? e.y : -e.y, (i & 4) != 0 ? e.z : -e.z);
          Vector3 at = transform.localToWorldMatrix.MultiplyPoint3x4(corner);
          if (i == 0) world = new Bounds(at, Vector3.zero);
          world.Encapsulate(at);
        }
        return world;
      }
    }
  }

  public sealed class MeshFilter : Component { public Mesh sharedMesh { get; set; } }
  public sealed class MeshRenderer : Renderer { }

  public sealed class SkinnedMeshRenderer : Renderer
  {
    Transform[] list = new Transform[0];
    readonly float[] shapeWeights = new float[16];
    public Mesh sharedMesh { get; set; }
    /// <summary>Of the list of bones that were made.</summary>
    public int Copies;
    public Transform[] bones { get { ++Copies; return (Transform[])list.Clone(); } set { list = (Transform[])value.Clone(); } }
    public float GetBlendShapeWeight(int shape) { return shapeWeights[shape]; }
    public void SetBlendShapeWeight(int shape, float weight) { shapeWeights[shape] = weight; }
    protected override Bounds LocalBounds { get { return sharedMesh.bounds; } }
  }

  public sealed class Rigidbody : Component
  {
    public float mass { get; set; }
    public Vector3 centerOfMass { get; set; }
    public Vector3 inertiaTensor { get; set; }
    public Quaternion inertiaTensorRotation { get; set; }
  }

  public sealed class MeshCollider : Component
  {
    public bool convex { get; set; }
    public Mesh sharedMesh { get; set; }
  }
}

namespace UnityEngine.Events
{
  public delegate void UnityAction<T0, T1>(T0 a, T1 b);

  public class UnityEvent<T0, T1>
  {
    UnityAction<T0, T1> listeners;
    public void AddListener(UnityAction<T0, T1> listener) { listeners += listener; }
    public void RemoveListener(UnityAction<T0, T1> listener) { listeners -= listener; }
    public void Invoke(T0 a, T1 b) { if (listeners != null) listeners(a, b); }
  }
}

namespace UnityEngine.Rendering
{
  public enum ShadowCastingMode { Off, On, TwoSided, ShadowsOnly }
  public enum LightProbeUsage { Off, BlendProbes }
  public enum ReflectionProbeUsage { Off, BlendProbes }
}
