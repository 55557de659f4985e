using System;
using System.Runtime.InteropServices;

namespace Sunder
{
  /// <summary>A bool of the C library: 4 bytes.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public struct NativeBool
  {
    uint value;

    public static implicit operator NativeBool(bool value)
    {
      NativeBool made = new NativeBool();
      made.value = value ? 1u : 0u;
      return made;
    }
    public static implicit operator bool(NativeBool value) { return value.value != 0; }
    public override string ToString() { return value != 0 ? "true" : "false"; }
  }

  [StructLayout(LayoutKind.Sequential)]
  public struct Vector2d
  {
    public double X, Y;
    public Vector2d(double x, double y) { X = x; Y = y; }
  }

  [StructLayout(LayoutKind.Sequential)]
  public struct Vector3d
  {
    public double X, Y, Z;
    public Vector3d(double x, double y, double z) { X = x; Y = y; Z = z; }
    public override string ToString() { return "(" + X + ", " + Y + ", " + Z + ")"; }
  }

  /// <summary>A rotation: x y z w, unit length.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public struct Vector4d
  {
    public double X, Y, Z, W;
    public Vector4d(double x, double y, double z, double w) { X = x; Y = y; Z = z; W = w; }
    public static Vector4d Identity { get { return new Vector4d(0, 0, 0, 1); } }
  }

  [StructLayout(LayoutKind.Sequential)]
  public struct Vector3f
  {
    public float X, Y, Z;
    public Vector3f(float x, float y, float z) { X = x; Y = y; Z = z; }
  }

  [StructLayout(LayoutKind.Sequential)]
  public struct Vector4f
  {
    public float X, Y, Z, W;
    public Vector4f(float x, float y, float z, float w) { X = x; Y = y; Z = z; W = w; }
  }

  /// <summary>Three indices.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public struct Triangle
  {
    public uint A, B, C;
    public Triangle(uint a, uint b, uint c) { A = a; B = b; C = c; }
  }

  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct Matrix3x3d
  {
    double xx, yx, zx, xy, yy, zy, xz, yz, zz;

    public double this[int row, int column] { get { return Matrices.Read(ref xx, row, column, 3); } }
  }

  /// <summary>A transform: three rows and four columns, the translation last; column after column in memory.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct Matrix3x4d
  {
    double xx, yx, zx, xy, yy, zy, xz, yz, zz, xw, yw, zw;

    public double this[int row, int column] { get { return Matrices.Read(ref xx, row, column, 4); } }
  }

  static unsafe class Matrices
  {
    internal static double Read(ref double first, int row, int column, int columns)
    {
      if ((uint)row >= 3) throw Epoch.OutOfRange(row, 3);
      if ((uint)column >= (uint)columns) throw Epoch.OutOfRange(column, columns);
      fixed (double* numbers = &first) return numbers[3 * column + row];
    }
  }
}
