using System;
using System.Text;

namespace Sunder
{
  static unsafe class Utf8
  {
    /// <summary>A text of the library; "" for null.</summary>
    internal static string Read(byte* text)
    {
      if (text == null) return "";
      int length = 0;
      while (text[length] != 0) ++length;
      return length == 0 ? "" : Encoding.UTF8.GetString(text, length);
    }

    /// <summary>Bytes that end with a zero; null for null.</summary>
    internal static byte[] Write(string text)
    {
      if (text == null) return null;
      if (text.IndexOf('\0') >= 0) throw new ArgumentException("a text with a zero in it cannot be handed to the library");
      byte[] bytes = new byte[Encoding.UTF8.GetByteCount(text) + 1];
      Encoding.UTF8.GetBytes(text, 0, text.Length, bytes, 0);
      return bytes;
    }
  }
}
