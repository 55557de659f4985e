using System;
using Sunder.Native;

namespace Sunder
{
  /// <summary>Where the tissue of a character differs from its material.</summary>
  public sealed unsafe class AuthoredTissue
  {
    /// <summary>Null: all factors are 1.</summary>
    public FactorField[] Fields;
    /// <summary>Null: none.</summary>
    public PerforatedLine[] Perforations;

    /// <summary>The structs last as long as the memory.</summary>
    internal void Write(NativeMemory memory, ref AssetOptions to)
    {
      to.FieldCount = (uint)(Fields == null ? 0 : Fields.Length);
      TissueField* fields = (TissueField*)memory.Take((long)to.FieldCount * sizeof(TissueField));
      for (int i = 0; i < to.FieldCount; ++i)
      {
        FactorField field = Fields[i];
        if (field == null || field.Values == null) throw new ArgumentNullException("Fields[" + i + "]");
        Library.CheckNotEmpty(field.Values, "Fields[" + i + "].Values");
        fields[i] = TissueField.Sized;
        fields[i].Mesh = (uint)field.Mesh;
        fields[i].Field = field.Factor;
        fields[i].ValueCount = (uint)field.Values.Length;
        fields[i].Values = (float*)memory.Pin(field.Values);
      }
      to.Fields = fields;
      to.PerforationCount = (uint)(Perforations == null ? 0 : Perforations.Length);
      Perforation* lines = (Perforation*)memory.Take((long)to.PerforationCount * sizeof(Perforation));
      for (int i = 0; i < to.PerforationCount; ++i)
      {
        PerforatedLine line = Perforations[i];
        if (line == null || line.Places == null) throw new ArgumentNullException("Perforations[" + i + "]");
        lines[i] = Perforation.Sized;
        lines[i].PlaceCount = (uint)line.Places.Length;
        // An array without elements has no address, but the library shall say that two are needed.
        lines[i].Places = (SurfacePlace*)(line.Places.Length > 0 ? memory.Pin(line.Places) : memory.Take(sizeof(SurfacePlace)));
        lines[i].Strength = line.Strength;
      }
      to.Perforations = lines;
    }
  }

  /// <summary>Factors of the material, per vertex of a mesh.</summary>
  public sealed class FactorField
  {
    public int Mesh;
    public TissueFactor Factor;
    /// <summary>From 0.001, of the tension from 0, to 1000.</summary>
    public float[] Values;
  }

  /// <summary>A line along which tissue is weaker, as between stamps.</summary>
  public sealed class PerforatedLine
  {
    /// <summary>At least two; straight in between; closed if the last is the first.</summary>
    public SurfacePlace[] Places;
    /// <summary>Of the toughness, and of the strain that is borne: from 0.001 to 1.</summary>
    public double Strength;
  }
}
