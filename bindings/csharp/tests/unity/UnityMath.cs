// Stands in for Unity, which is not to be had here: as much of its interface as the package uses, with its meaning.
using System;

namespace UnityEngine
{
  public struct Vector2
  {
    public float x, y;
    public Vector2(float x, float y) { this.x = x; this.y = y; }
  }

  public struct Vector3
  {
    public float x, y, z;
    public Vector3(float x, float y, float z) { this.x = x; this.y = y; this.z = z; }
    public static Vector3 zero { get { return new Vector3(); } }
    public static Vector3 one { get { return new Vector3(1, 1, 1); } }
    public float magnitude { get { return (float)Math.Sqrt(Dot(this, this)); } }
    public static float Dot(Vector3 a, Vector3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
    public static Vector3 Cross(Vector3 a, Vector3 b) { return new Vector3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x); }
    public static Vector3 operator +(Vector3 a, Vector3 b) { return new Vector3(a.x + b.x, a.y + b.y, a.z + b.z); }
    public static Vector3 operator -(Vector3 a, Vector3 b) { return new Vector3(a.x - b.x, a.y - b.y, a.z - b.z); }
    public static Vector3 operator *(float f, Vector3 v) { return new Vector3(f * v.x, f * v.y, f * v.z); }
    public static bool operator ==(Vector3 a, Vector3 b) { return (a - b).magnitude < 1e-5f; }
    public static bool operator !=(Vector3 a, Vector3 b) { return !(a == b); }
    public override bool Equals(object other) { return other is Vector3 && this == (Vector3)other; }
    public override int GetHashCode() { return x.GetHashCode() ^ y.GetHashCode() ^ z.GetHashCode(); }
    public override string ToString() { return "(" + x + ", " + y + ", " + z + ")"; }
  }

  public struct Vector4
  {
    public float x, y, z, w;
    public Vector4(float x, float y, float z, float w) { this.x = x; this.y = y; this.z = z; this.w = w; }
  }

  public struct Color
  {
    public float r, g, b, a;
    public Color(float r, float g, float b, float a) { this.r = r; this.g = g; this.b = b; this.a = a; }
  }

  public struct Ray
  {
    public Vector3 origin, direction;
    public Ray(Vector3 origin, Vector3 direction) { this.origin = origin; this.direction = direction; }
  }

  public struct Quaternion
  {
    public float x, y, z, w;
    public Quaternion(float x, float y, float z, float w) { this.x = x; this.y = y; this.z = z; this.w = w; }
    public static Quaternion identity { get { return new Quaternion(0, 0, 0, 1); } }
    public static Quaternion Inverse(Quaternion q) { return new Quaternion(-q.x, -q.y, -q.z, q.w); }
    public static Quaternion AngleAxis(float degrees, Vector3 axis)
    {
      double half = degrees * Math.PI / 360, length = axis.magnitude;
      float s = (float)(Math.Sin(half) / length);
      return new Quaternion(s * axis.x, s * axis.y, s * axis.z, (float)Math.Cos(half));
    }
    public static Quaternion operator *(Quaternion a, Quaternion b)
    {
      return new Quaternion(a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y, a.w * b.y + a.y * b.w + a.z * b.x - a.x * b.z,
        a.w * b.z + a.z * b.w + a.x * b.y - a.y * b.x, a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z);
    }
    public static Vector3 operator *(Quaternion q, Vector3 v)
    {
      Vector3 axis = new Vector3(q.x, q.y, q.z), t = 2 * Vector3.Cross(axis, v);
      return v + q.w * t + Vector3.Cross(axis, t);
    }
  }

  public struct Matrix4x4
  {
    public float m00, m10, m20, m30, m01, m11, m21, m31, m02, m12, m22, m32, m03, m13, m23, m33;

    public static Matrix4x4 identity { get { Matrix4x4 m = new Matrix4x4(); m.m00 = m.m11 = m.m22 = m.m33 = 1; return m; } }

    public unsafe float this[int row, int column]
    {
      get { fixed (float* first = &m00) return first[4 * column + row]; }
      set { fixed (float* first = &m00) first[4 * column + row] = value; }
    }

    public static Matrix4x4 TRS(Vector3 t, Quaternion q, Vector3 s)
    {
      Matrix4x4 m = identity;
      m.SetColumn(0, q * new Vector3(s.x, 0, 0));
      m.SetColumn(1, q * new Vector3(0, s.y, 0));
      m.SetColumn(2, q * new Vector3(0, 0, s.z));
      m.SetColumn(3, t);
      return m;
    }

    void SetColumn(int c, Vector3 v)
    {
      this[0, c] = v.x;
      this[1, c] = v.y;
      this[2, c] = v.z;
    }

    public static Matrix4x4 operator *(Matrix4x4 a, Matrix4x4 b)
    {
      Matrix4x4 m = new Matrix4x4();
      for (int r = 0; r < 4; ++r)
        for (int c = 0; c < 4; ++c)
        {
          double sum = 0;
          for (int k = 0; k < 4; ++k) sum += (double)a[r, k] * b[k, c];
          m[r, c] = (float)sum;
        }
      return m;
    }

    public Vector3 MultiplyPoint3x4(Vector3 p) { return MultiplyVector(p) + new Vector3(m03, m13, m23); }
    public Vector3 MultiplyVector(Vector3 v)
    {
      return new Vector3(m00 * v.x + m01 * v.y + m02 * v.z, m10 * v.x + m11 * v.y + m12 * v.z, m20 * v.x + m21 * v.y + m22 * v.z);
    }

    void SetRow(int r, Vector3 v, Vector3 translation)
    {
      this[r, 0] = v.x;
      this[r, 1] = v.y;
      this[r, 2] = v.z;
      this[r, 3] = -Vector3.Dot(v, translation);
    }

    Vector3 Column(int c) { return new Vector3(this[0, c], this[1, c], this[2, c]); }

    /// <summary>Of an affine one.</summary>
    public Matrix4x4 inverse
    {
      get
      {
        Vector3 x = Column(0), y = Column(1), z = Column(2);
        double d = Vector3.Dot(x, Vector3.Cross(y, z));
        Matrix4x4 m = identity;
        m.SetRow(0, (float)(1 / d) * Vector3.Cross(y, z), Column(3));
        m.SetRow(1, (float)(1 / d) * Vector3.Cross(z, x), Column(3));
        m.SetRow(2, (float)(1 / d) * Vector3.Cross(x, y), Column(3));
        return m;
      }
    }

    public Vector3 lossyScale { get { return new Vector3(Column(0).magnitude, Column(1).magnitude, Column(2).magnitude); } }

    public Quaternion rotation
    {
      get
      {
        Vector3 s = lossyScale, x = (1 / s.x) * Column(0), y = (1 / s.y) * Column(1), z = (1 / s.z) * Column(2);
        double w = Math.Sqrt(Math.Max(0, 1 + x.x + y.y + z.z)) / 2, qx = Math.Sqrt(Math.Max(0, 1 + x.x - y.y - z.z)) / 2;
        double qy = Math.Sqrt(Math.Max(0, 1 - x.x + y.y - z.z)) / 2, qz = Math.Sqrt(Math.Max(0, 1 - x.x - y.y + z.z)) / 2;
        return new Quaternion((float)(y.z < z.y ? -qx : qx), (float)(z.x < x.z ? -qy : qy), (float)(x.y < y.x ? -qz : qz), (float)w);
      }
    }
  }

  public struct Bounds
  {
    public Vector3 center, extents;
    public Bounds(Vector3 center, Vector3 size) { this.center = center; extents = 0.5f * size; }
    public Vector3 min { get { return center - extents; } }
    public Vector3 max { get { return center + extents; } }
    public Vector3 size { get { return 2 * extents; } }
    public void Encapsulate(Vector3 p)
    {
      Vector3 a = min, b = max;
      a = new Vector3(Math.Min(a.x, p.x), Math.Min(a.y, p.y), Math.Min(a.z, p.z));
      b = new Vector3(Math.Max(b.x, p.x), Math.Max(b.y, p.y), Math.Max(b.z, p.z));
      this = new Bounds(0.5f * (a + b), b - a);
    }
    public bool Intersects(Bounds o)
    {
      return min.x <= o.max.x && max.x >= o.min.x && min.y <= o.max.y && max.y >= o.min.y && min.z <= o.max.z && max.z >= o.min.z;
    }
  }
}
