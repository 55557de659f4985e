using System;
using Sunder.Native;

namespace Sunder
{
  /// <summary>CharacterArrays as structs of the library. It cannot know the lengths of arrays, so they are checked here.</summary>
  static unsafe class CharacterStructs
  {
    internal static CharacterData Write(CharacterArrays from, NativeMemory memory)
    {
      CharacterData data = CharacterData.Default;
      data.Name = memory.Text(from.Name);
      data.BoneCount = (uint)Length(from.Bones);
      data.Bones = (Native.Bone*)memory.Take((long)data.BoneCount * sizeof(Native.Bone));
      for (int i = 0; i < data.BoneCount; ++i)
      {
        BoneArrays bone = Element(from.Bones, i, "Bones");
        data.Bones[i].Name = memory.Text(bone.Name);
        data.Bones[i].Parent = bone.Parent < 0 ? Constants.None : (uint)bone.Parent;
        data.Bones[i].Rest = bone.Rest;
      }
      data.SkinCount = (uint)Length(from.Skins);
      data.Skins = (Skin*)memory.Take((long)data.SkinCount * sizeof(Skin));
      for (int i = 0; i < data.SkinCount; ++i) WriteSkin(Element(from.Skins, i, "Skins"), "skin " + i + ": ", memory, &data.Skins[i]);
      data.MeshCount = (uint)Length(from.Meshes);
      data.Meshes = (Native.Mesh*)memory.Take((long)data.MeshCount * sizeof(Native.Mesh));
      for (int i = 0; i < data.MeshCount; ++i)
      {
        MeshArrays mesh = Element(from.Meshes, i, "Meshes");
        WriteMesh(mesh, "mesh " + i + ": ", memory, &data.Meshes[i]);
        data.Meshes[i].FirstMorphWeight = data.MorphWeightCount;
        data.MorphWeightCount += (uint)Length(mesh.MorphTargets);
      }
      data.ClipCount = (uint)Length(from.Clips);
      data.Clips = (Clip*)memory.Take((long)data.ClipCount * sizeof(Clip));
      for (int i = 0; i < data.ClipCount; ++i) WriteClip(Element(from.Clips, i, "Clips"), "clip " + i + ": ", memory, &data.Clips[i]);
      float[] weights = from.RestMorphWeights ?? new float[data.MorphWeightCount];
      Library.CheckLength(weights, data.MorphWeightCount, "RestMorphWeights");
      data.RestMorphWeights = (float*)memory.Pin(weights);
      return data;
    }

    static void WriteSkin(SkinArrays from, string where, NativeMemory memory, Skin* to)
    {
      to->Name = memory.Text(from.Name);
      to->SlotCount = (uint)Length(from.Bones);
      Library.CheckLength(from.BoneFromBind, 12L * to->SlotCount, where + "BoneFromBind");
      to->Bones = (uint*)memory.Pin(from.Bones);
      to->BoneFromBind = (float*)memory.Pin(from.BoneFromBind);
    }

    static void WriteMesh(MeshArrays from, string where, NativeMemory memory, Native.Mesh* to)
    {
      if (from.Positions == null) throw new ArgumentNullException(where + "Positions");
      if (from.Positions.Length % 3 != 0) throw new ArgumentException(where + "Positions has " + from.Positions.Length + " elements; 3 per vertex are needed");
      long vertices = from.Positions.Length / 3;
      to->Name = memory.Text(from.Name);
      to->Skin = (uint)from.Skin;
      to->VertexCount = (uint)vertices;
      to->Positions = (float*)memory.Pin(from.Positions);
      to->Normals = Floats(from.Normals, 3 * vertices, where + "Normals", memory);
      to->Tangents = Floats(from.Tangents, 4 * vertices, where + "Tangents", memory);
      to->UvSetCount = (uint)Length(from.UvSets);
      to->UvSets = Sets(from.UvSets, 2 * vertices, where + "UvSets", memory);
      to->ColorSetCount = (uint)Length(from.ColorSets);
      to->ColorSets = Sets(from.ColorSets, 4 * vertices, where + "ColorSets", memory);
      WriteAttributes(from, vertices, where, memory, to);
      to->MorphTargetCount = (uint)Length(from.MorphTargets);
      to->MorphTargets = (MorphTarget*)memory.Take((long)to->MorphTargetCount * sizeof(MorphTarget));
      for (int i = 0; i < to->MorphTargetCount; ++i)
      {
        MorphTargetArrays target = Element(from.MorphTargets, i, where + "MorphTargets");
        string name = where + "morph target " + i + ": ";
        to->MorphTargets[i].Name = memory.Text(target.Name);
        to->MorphTargets[i].PositionDeltas = Floats(target.PositionDeltas, 3 * vertices, name + "PositionDeltas", memory);
        to->MorphTargets[i].NormalDeltas = Floats(target.NormalDeltas, 3 * vertices, name + "NormalDeltas", memory);
        to->MorphTargets[i].TangentDeltas = Floats(target.TangentDeltas, 3 * vertices, name + "TangentDeltas", memory);
      }
      WriteInfluences(from, vertices, where, memory, to);
      WriteTriangles(from, where, memory, to);
    }

    static void WriteAttributes(MeshArrays from, long vertices, string where, NativeMemory memory, Native.Mesh* to)
    {
      to->AttributeCount = (uint)Length(from.Attributes);
      to->Attributes = (Native.Attribute*)memory.Take((long)to->AttributeCount * sizeof(Native.Attribute));
      for (int i = 0; i < to->AttributeCount; ++i)
      {
        AttributeArrays attribute = Element(from.Attributes, i, where + "Attributes");
        Library.CheckLength(attribute.Values, attribute.Components * vertices, where + "attribute " + i);
        to->Attributes[i].Name = memory.Text(attribute.Name);
        to->Attributes[i].Values = (float*)memory.Pin(attribute.Values);
        to->Attributes[i].Components = (uint)attribute.Components;
        to->Attributes[i].IsLabel = attribute.IsLabel;
      }
    }

    static void WriteInfluences(MeshArrays from, long vertices, string where, NativeMemory memory, Native.Mesh* to)
    {
      Library.CheckLength(from.FirstInfluence, vertices + 1, where + "FirstInfluence");
      uint last = 0;
      foreach (uint first in from.FirstInfluence)
      {
        if (first < last) throw new ArgumentException(where + "FirstInfluence descends from " + last + " to " + first);
        last = first;
      }
      Library.CheckLength(from.Influences, last, where + "Influences");
      to->FirstInfluence = (uint*)memory.Pin(from.FirstInfluence);
      to->Influences = (Influence*)memory.Pin(from.Influences);
    }

    static void WriteTriangles(MeshArrays from, string where, NativeMemory memory, Native.Mesh* to)
    {
      if (from.Triangles == null) throw new ArgumentNullException(where + "Triangles");
      if (from.Triangles.Length % 3 != 0) throw new ArgumentException(where + "Triangles has " + from.Triangles.Length + " elements; 3 per triangle are needed");
      uint[] submesh = from.TriangleSubmesh ?? new uint[from.Triangles.Length / 3];
      SubmeshArrays[] submeshes = from.Submeshes ?? new[] { new SubmeshArrays() };
      Library.CheckLength(submesh, from.Triangles.Length / 3, where + "TriangleSubmesh");
      to->TriangleCount = (uint)from.Triangles.Length / 3;
      to->Triangles = (uint*)memory.Pin(from.Triangles);
      to->TriangleSubmesh = (uint*)memory.Pin(submesh);
      to->SubmeshCount = (uint)submeshes.Length;
      to->Submeshes = (Submesh*)memory.Take((long)submeshes.Length * sizeof(Submesh));
      for (int i = 0; i < submeshes.Length; ++i)
      {
        to->Submeshes[i].Name = memory.Text(Element(submeshes, i, where + "Submeshes").Name);
        to->Submeshes[i].Material = submeshes[i].Material ?? Constants.None;
      }
    }

    static void WriteClip(ClipArrays from, string where, NativeMemory memory, Clip* to)
    {
      to->Name = memory.Text(from.Name);
      to->Duration = from.Duration;
      to->ChannelCount = (uint)Length(from.Channels);
      to->Channels = (Channel*)memory.Take((long)to->ChannelCount * sizeof(Channel));
      for (int i = 0; i < to->ChannelCount; ++i)
      {
        ChannelArrays channel = Element(from.Channels, i, where + "Channels");
        long width = channel.Width * (channel.Interpolation == Interpolation.Cubic ? 3L : 1L);
        Library.CheckLength(channel.Values, width * Length(channel.Times), where + "channel " + i + ": Values");
        to->Channels[i].Times = (float*)memory.Pin(channel.Times);
        to->Channels[i].Values = (float*)memory.Pin(channel.Values);
        to->Channels[i].KeyCount = (uint)Length(channel.Times);
        to->Channels[i].Target = channel.Target;
        to->Channels[i].Index = (uint)channel.Index;
        to->Channels[i].Width = (uint)channel.Width;
        to->Channels[i].Interpolation = channel.Interpolation;
      }
    }

    static float* Floats(float[] values, long wanted, string name, NativeMemory memory)
    {
      if (values != null) Library.CheckLength(values, wanted, name);
      return (float*)memory.Pin(values);
    }

    static float** Sets(float[][] sets, long wanted, string name, NativeMemory memory)
    {
      float** to = (float**)memory.Take((long)Length(sets) * sizeof(float*));
      for (int i = 0; i < Length(sets); ++i) to[i] = Floats(Element(sets, i, name), wanted, name + "[" + i + "]", memory);
      return to;
    }

    static int Length(Array array) { return array == null ? 0 : array.Length; }

    static T Element<T>(T[] array, int index, string name) where T : class
    {
      if (array[index] == null) throw new ArgumentNullException(name + "[" + index + "]");
      return array[index];
    }
  }
}
