using System;
using Sunder.Native;

namespace Sunder
{
  /// <summary>One kind of fault, over all vertices that have it, and the worst place.</summary>
  public struct Finding
  {
    /// <summary>"SUNDER_W_SUM".</summary>
    public string Code;
    /// <summary>What is wrong, where, how much.</summary>
    public string Text;
    /// <summary>What to do about it.</summary>
    public string Advice;
    public string Unit;
    public double Value, Threshold;
    /// <summary>Vertices, bones or edges concerned.</summary>
    public ulong Count;
    public Severity Severity;
    public Evidence Evidence;
    public uint? Mesh, Vertex, Bone;
  }

  /// <summary>Two skins compared; docs/validation.md explains the figures.</summary>
  public sealed unsafe class ValidationReport : IDisposable
  {
    readonly ReportHandle handle;
    readonly Epoch epoch;

    internal ValidationReport(uint number)
    {
      handle = new ReportHandle(number);
      epoch = new Epoch(handle, "");
    }

    /// <summary>Compares the skin of a target with that of its source. O(vertices x poses).</summary>
    public static ValidationReport Compare(Character source, Character target, ValidationOptions? options = null)
    {
      if (source == null) throw new ArgumentNullException("source");
      if (target == null) throw new ArgumentNullException("target");
      ValidationOptions chosen = options ?? ValidationOptions.Default;
      uint report;
      SunderException.Check(NativeCalls.sunder_validate(source.Number, target.Number, &chosen, &report));
      GC.KeepAlive(source);
      GC.KeepAlive(target);
      return new ValidationReport(report);
    }

    public ReportInfo Info
    {
      get
      {
        ReportInfo info = ReportInfo.Sized;
        SunderException.Check(NativeCalls.sunder_get_report(handle.Number, &info));
        GC.KeepAlive(this);
        return info;
      }
    }

    /// <summary>By severity, errors first.</summary>
    public Finding[] GetFindings()
    {
      Native.Finding* findings;
      uint count;
      SunderException.Check(NativeCalls.sunder_get_findings(handle.Number, &findings, &count));
      Finding[] copies = new Finding[count];
      for (int i = 0; i < copies.Length; ++i)
      {
        copies[i].Code = Utf8.Read(findings[i].Code);
        copies[i].Text = Utf8.Read(findings[i].Text);
        copies[i].Advice = Utf8.Read(findings[i].Advice);
        copies[i].Unit = Utf8.Read(findings[i].Unit);
        copies[i].Value = findings[i].Value;
        copies[i].Threshold = findings[i].Threshold;
        copies[i].Count = findings[i].Count;
        copies[i].Severity = findings[i].Severity;
        copies[i].Evidence = findings[i].Evidence;
        copies[i].Mesh = Index(findings[i].Mesh);
        copies[i].Vertex = Index(findings[i].Vertex);
        copies[i].Bone = Index(findings[i].Bone);
      }
      GC.KeepAlive(this);
      return copies;
    }

    /// <summary>Per vertex of the target: the largest deviation over the poses that were tried, and the bound for all poses, metres.
    /// NaN: no match, or no bound.</summary>
    public FloatView GetDeviations(out FloatView bounds)
    {
      float* deviations;
      float* bound;
      uint count;
      SunderException.Check(NativeCalls.sunder_get_vertex_deviations(handle.Number, &deviations, &bound, &count));
      GC.KeepAlive(this);
      bounds = new FloatView(bound, count, epoch.Now);
      return new FloatView(deviations, count, epoch.Now);
    }

    static uint? Index(uint index) { return index == Constants.None ? (uint?)null : index; }

    public void Dispose() { handle.Dispose(); }
  }
}
