using System;
using System.Collections.Generic;
using Sunder.Native;

namespace Sunder
{
  /// <summary>Instances that are updated together, once per frame. One thread at a time, but operations may be submitted from any.</summary>
  public sealed unsafe class Scene : IDisposable
  {
    readonly SceneHandle handle;
    readonly Dictionary<ulong, Instance> instances = new Dictionary<ulong, Instance>();
    Result* results;
    int resultCount;
    int resultVersion;

    /// <summary>options: hooks of a job system are pointers to native functions, which must stay.</summary>
    public Scene(SceneOptions? options = null)
    {
      Library.Require();
      SceneOptions chosen = options ?? SceneOptions.Default;
      if ((Library.Features & Features.Threads) == 0) chosen.Threads = 1;
      uint number;
      SunderException.Check(NativeCalls.sunder_create_scene(&chosen, &number));
      handle = new SceneHandle(number);
      Drawing = new Epoch(handle, "the scene was updated or changed since this view was made: ask the instance for it again");
      MeshTables = new Epoch(handle, "another mesh of the scene was asked for since: ask for this one again");
    }

    internal uint Number { get { return handle.Number; } }

    /// <summary>Counts what makes views of instances invalid.</summary>
    internal Epoch Drawing { get; private set; }

    /// <summary>Counts what makes the tables of pointers of Instance.GetMesh() invalid.</summary>
    internal Epoch MeshTables { get; private set; }

    internal void Change()
    {
      Drawing.Advance();
      MeshTables.Advance();
    }

    /// <summary>An instance in the rest pose.</summary>
    public Instance Spawn(CharacterAsset asset, SpawnOptions? options = null)
    {
      if (asset == null) throw new ArgumentNullException("asset");
      SpawnOptions chosen = options ?? SpawnOptions.Default;
      ulong id;
      SunderException.Check(NativeCalls.sunder_spawn(Number, asset.Number, &chosen, &id));
      return Add(id, asset);
    }

    /// <summary>The instance of a number, as one that Restore() has made in a new scene.</summary>
    public Instance Adopt(ulong id, CharacterAsset asset)
    {
      if (asset == null) throw new ArgumentNullException("asset");
      uint exists;
      SunderException.Check(NativeCalls.sunder_has_instance(Number, id, &exists));
      if (exists == 0) throw new ArgumentException("the scene has no instance " + id, "id");
      return Add(id, asset);
    }

    Instance Add(ulong id, CharacterAsset asset)
    {
      Instance instance = new Instance(this, id, asset);
      lock (instances) instances[id] = instance;
      GC.KeepAlive(asset);
      return instance;
    }

    internal void Forget(ulong id) { lock (instances) instances.Remove(id); }

    /// <summary>The instance of a number, or null.</summary>
    public Instance Find(ulong id)
    {
      Instance instance;
      lock (instances) return instances.TryGetValue(id, out instance) ? instance : null;
    }

    public int InstanceCount
    {
      get
      {
        uint count;
        SunderException.Check(NativeCalls.sunder_get_instance_count(Number, &count));
        GC.KeepAlive(this);
        return (int)count;
      }
    }

    /// <summary>Advances by a frame: samples clips, applies commands, steps tissue, poses the vertices that changed. Allocates
    /// nothing that the garbage collector would have to take.</summary>
    public void Update(double seconds)
    {
      Change();
      ForgetResults();
      SunderException.Check(NativeCalls.sunder_update(Number, seconds));
      Result* first;
      uint count;
      SunderException.Check(NativeCalls.sunder_get_results(Number, &first, &count));
      results = first;
      resultCount = (int)count;
      GC.KeepAlive(this);
    }

    /// <summary>They are not current any more.</summary>
    void ForgetResults()
    {
      resultCount = 0;
      ++resultVersion;
    }

    /// <summary>Outcomes of the commands that the last update applied.</summary>
    public int ResultCount { get { return resultCount; } }

    /// <summary>Ascending by command.</summary>
    public OperationResult GetResult(int index)
    {
      CheckResults(resultVersion);
      if ((uint)index >= (uint)resultCount) throw Epoch.OutOfRange(index, resultCount);
      return new OperationResult(results[index], this, resultVersion);
    }

    internal bool TryGetResult(ulong command, out OperationResult result)
    {
      CheckResults(resultVersion);
      for (int i = 0; i < resultCount; ++i)
      {
        if (results[i].Command != command) continue;
        result = GetResult(i);
        return true;
      }
      GC.KeepAlive(this);
      result = default(OperationResult);
      return false;
    }

    /// <summary>Results are the library's until the next update.</summary>
    internal void CheckResults(int version)
    {
      uint number = Number;
      if (version != resultVersion) throw new StaleViewException("this result is of an earlier update");
    }

    /// <summary>Numbers of the instances that the last update posed anew.</summary>
    public ULongView Drawn
    {
      get
      {
        ulong* first;
        uint count;
        SunderException.Check(NativeCalls.sunder_get_drawn(Number, &first, &count));
        return new ULongView(first, count, Drawing.Now);
      }
    }

    /// <summary>Figures of the last update.</summary>
    public FrameStats Stats
    {
      get
      {
        FrameStats stats = FrameStats.Sized;
        SunderException.Check(NativeCalls.sunder_get_frame_stats(Number, &stats));
        GC.KeepAlive(this);
        return stats;
      }
    }

    /// <summary>Limits the optional work of the following updates; Constants.None: no limit.</summary>
    public void SetBudget(uint settledPoints, uint modelWork)
    {
      SunderException.Check(NativeCalls.sunder_set_budget(Number, settledPoints, modelWork));
      GC.KeepAlive(this);
    }

    /// <summary>The state of all instances, without their assets.</summary>
    public byte[] Save()
    {
      uint bytes;
      SunderException.Check(NativeCalls.sunder_save_scene(Number, &bytes));
      GC.KeepAlive(this);
      return Library.Take(bytes);
    }

    /// <summary>Makes the scene one that was saved, with instances of the same numbers: those of another scene are had by Adopt(). The
    /// bytes are not trusted. assets: those of the scene that was saved.</summary>
    public void Restore(byte[] snapshot, CharacterAsset[] assets, RestoreOptions? options = null)
    {
      if (snapshot == null) throw new ArgumentNullException("snapshot");
      if (assets == null) throw new ArgumentNullException("assets");
      RestoreOptions chosen = options ?? RestoreOptions.Default;
      uint[] numbers = new uint[assets.Length];
      for (int i = 0; i < assets.Length; ++i) numbers[i] = assets[i].Number;
      Change();
      fixed (byte* bytes = snapshot)
      fixed (uint* first = numbers)
        SunderException.Check(NativeCalls.sunder_restore_scene(Number, bytes, (ulong)snapshot.LongLength, first, (uint)numbers.Length, &chosen));
      ForgetResults();
      GC.KeepAlive(assets);
    }

    /// <summary>Whether Dispose() was called.</summary>
    public bool IsDisposed { get { return handle.IsClosed; } }

    public void Dispose() { handle.Dispose(); }
  }
}
