// Debian's Mono has no System.Memory: as much of a span as Views.cs uses, so that what Unity 2021.2 sees compiles too.
namespace System
{
  public readonly ref struct ReadOnlySpan<T>
  {
    readonly int length;
    public unsafe ReadOnlySpan(void* first, int length) { this.length = first == null ? 0 : length; }
    public int Length { get { return length; } }
  }
}
