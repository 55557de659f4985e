using System;
using System.IO;

namespace Sunder.Tests
{
  /// <summary>What is used wrongly is refused with a text, and nothing is read that is not there.</summary>
  static unsafe class Misuse
  {
    static Instance Spawn(Character character)
    {
      Instance instance = new Scene().Spawn(new CharacterAsset(character));
      instance.Scene.Update(0);
      return instance;
    }

    internal static void DisposedObjects(Character character)
    {
      Instance instance = Spawn(character);
      FloatView positions = instance.GetPosedMesh().Positions;
      Command command = instance.Undo();
      instance.Scene.Dispose();
      instance.Scene.Dispose();  // twice does no harm
      Expect.Throws<ObjectDisposedException>(() => instance.Scene.Update(0.01), "Scene");
      Expect.Throws<ObjectDisposedException>(() => instance.Tear(new BladePosition[2]), "Scene");
      Expect.Throws<ObjectDisposedException>(() => positions[0].ToString(), "Scene");
      Expect.Throws<ObjectDisposedException>(() => command.Result.Check(), "Scene");
      Character copy = Character.FromGlb(character.ToGlb());
      CharacterAsset asset = new CharacterAsset(copy);
      MeshView mesh = copy.GetMesh(0);
      copy.Dispose();
      Expect.Throws<ObjectDisposedException>(() => mesh.Positions[0].ToString(), "Character");
      Expect.Throws<ObjectDisposedException>(() => mesh.UvSet(0), "Character");
      Expect.Throws<ObjectDisposedException>(() => copy.FindBone("bone0"), "Character");
      using (Scene scene = new Scene())
      {
        scene.Spawn(asset).SetMatrices(new double[12 * copy.BoneCount]);  // the asset lives on
        scene.Update(0);
        asset.Dispose();
        Expect.Throws<ObjectDisposedException>(() => scene.Spawn(asset), "CharacterAsset");
      }
    }

    internal static void StaleViews(Character character)
    {
      Instance instance = Spawn(character);
      FloatView positions = instance.GetPosedMesh().Positions;
      PosedMesh posed = instance.GetPosedMesh();
      MeshView first = instance.GetMesh();
      UIntView triangles = first.Triangles;
      Expect.That(positions[0] == posed.Positions[0] && first.UvSet(0).Count > 0, "fresh views are read");
      instance.GetMesh();
      Expect.Throws<StaleViewException>(() => first.UvSet(0), "another mesh");
      Expect.That(triangles[0] < posed.VertexCount, "arrays stay");
      instance.Scene.Update(0.01);
      Expect.Throws<StaleViewException>(() => positions[0].ToString(), "updated or changed");
      Expect.Throws<StaleViewException>(() => posed.DirtyVertices[0].ToString(), "updated or changed");
      Expect.Throws<StaleViewException>(() => triangles.ToArray(), "updated or changed");
      Expect.Throws<StaleViewException>(() => new IntPtr(positions.Pointer).ToString(), "updated or changed");
      positions = instance.GetPosedMesh().Positions;
      instance.PrepareToTear();
      Expect.Throws<StaleViewException>(() => positions[0].ToString(), "updated or changed");
      positions = instance.GetPosedMesh().Positions;
      Expect.Throws<ArgumentOutOfRangeException>(() => positions[positions.Count].ToString(), "the array has");
      Expect.Throws<ArgumentOutOfRangeException>(() => positions[-1].ToString(), "the array has");
      Expect.Throws<ArgumentException>(() => positions.CopyTo(new float[positions.Count], 1), "has no room");
      Expect.Throws<ArgumentOutOfRangeException>(() => default(FloatView)[0].ToString(), "0 elements");
      Command command = instance.Undo();
      instance.Scene.Update(0);
      OperationResult failed;
      Expect.That(command.TryGetResult(out failed) && !failed.Succeeded, "nothing to undo");
      Expect.Fails(() => command.Result.Check(), failed.Status, failed.Error);
      instance.Scene.Update(0);
      Expect.Throws<StaleViewException>(() => failed.Error.ToString(), "earlier update");
      Expect.Throws<InvalidOperationException>(() => command.Result.Check(), "did not apply");
    }

    internal static void WrongArrays(Character character)
    {
      Instance instance = Spawn(character);
      int bones = character.BoneCount;
      Expect.Throws<ArgumentException>(() => instance.SetMatrices(new double[12 * bones - 1]), "modelFromBone has");
      Expect.Throws<ArgumentNullException>(() => instance.SetMatrices(null), "modelFromBone");
      Expect.Throws<ArgumentException>(() => instance.SetTransforms(new BoneTransform[bones + 1]), "transforms has");
      Expect.Throws<ArgumentException>(() => instance.SetMatrices(new double[12 * bones], new float[character.MorphWeightCount + 1]), "morphWeights has");
      Expect.Throws<ArgumentException>(() => character.ComputeMatrices(null, new double[3]), "modelFromBone has 3 elements");
      Expect.Throws<ArgumentNullException>(() => instance.Tear(null), "blades");
      Expect.Throws<ArgumentNullException>(() => Character.FromGlb(null), "glb");
      Expect.Throws<ArgumentException>(() => character.FindBone("bone0\0"), "zero in it");
      Expect.Throws<ArgumentOutOfRangeException>(() => character.GetBone(bones), "elements");
      Expect.Fails(() => character.FindBone("no such bone"), Status.NotFound, "not_found");
      Expect.Fails(() => Character.FromGlb(new byte[0]), Status.NullPointer);
      Expect.Fails(() => Character.FromGlb(new byte[100]), Status.UnsupportedFormat);
      Expect.Fails(() => instance.GetPosedMesh(7), Status.IndexOutOfRange, "mesh 7");
      Expect.Fails(() => instance.Tear(new BladePosition[2], new TearOptions()), Status.InvalidStruct);
      Expect.Fails(() => instance.Tear(new BladePosition[0]), Status.NullPointer);
      Expect.Fails(() => instance.ApplyLog("{]"), Status.MalformedFile);
      PlaneCut cut = PlaneCut.Default;
      cut.Normal = new Vector3d(0, 1, 0);
      Expect.Throws<ArgumentException>(() => instance.Cut(cut, new Vector3d[0]), "bounds is empty");
      Expect.Throws<ArgumentException>(() => instance.Cut(cut, null, new Vector3d[0]), "sections is empty");
      Expect.Throws<ArgumentException>(() => new CharacterAsset(character, null, new TissueMaterial[0]), "materials is empty");
      Expect.Throws<ArgumentException>(() => instance.Scene.Adopt(instance.Id + 1, instance.Asset), "no instance");
      Expect.That(instance.Scene.Find(instance.Id) == instance, "instances are found");
      instance.Destroy();
      Expect.That(!instance.Exists && instance.Scene.InstanceCount == 0, "it is destroyed");
      Expect.Fails(() => instance.GetPosedMesh(), Status.NotFound);
    }

    /// <summary>After an update that failed there are no results, also not those of the update before.</summary>
    internal static void FailedUpdates(Character character)
    {
      Instance instance = Spawn(character);
      Command command = instance.Undo();
      instance.Scene.Update(0);
      OperationResult before = instance.Scene.GetResult(0), found;
      Expect.Fails(() => instance.Scene.Update(double.NaN), Status.NonFiniteValue);
      Expect.Equal(instance.Scene.ResultCount, 0, "results");
      Expect.That(!command.TryGetResult(out found), "a result of an earlier update");
      Expect.Throws<StaleViewException>(() => before.Error.ToString(), "earlier update");
      instance.Scene.Update(0);
    }

    /// <summary>Default of a struct asks for the library's version first: as if nothing had been called yet.</summary>
    internal static void VersionsAreChecked()
    {
      System.Reflection.FieldInfo isChecked = typeof(Library).GetField("isChecked", System.Reflection.BindingFlags.Static | System.Reflection.BindingFlags.NonPublic);
      foreach (Action first in new Action[] { () => TearOptions.Default.ToString(), () => TissueMaterial.Default.ToString(), () => Tissue.Find("skin").ToString(),
        () => Native.CharacterData.Default.ToString() })
      {
        isChecked.SetValue(null, false);
        first();
        Expect.Equal((bool)isChecked.GetValue(null), true, "the version was checked");
      }
    }

    internal static void WrongCharacterArrays()
    {
      Expect.Throws<ArgumentException>(() => Changed(a => a.Meshes[0].Normals = new float[3]), "mesh 0: Normals has 3 elements; 9 are needed");
      Expect.Throws<ArgumentException>(() => Changed(a => a.Meshes[0].UvSets = new[] { new float[2] }), "mesh 0: UvSets[0] has 2");
      Expect.Throws<ArgumentException>(() => Changed(a => a.Meshes[0].Triangles = new uint[4]), "3 per triangle");
      Expect.Throws<ArgumentException>(() => Changed(a => a.Meshes[0].FirstInfluence[1] = 3), "descends from 3 to 2");
      Expect.Throws<ArgumentException>(() => Changed(a => a.Meshes[0].FirstInfluence[3] = 9), "Influences has 3 elements; 9 are needed");
      Expect.Throws<ArgumentException>(() => Changed(a => a.Skins[0].BoneFromBind = new float[11]), "skin 0: BoneFromBind");
      Expect.Throws<ArgumentException>(() => Changed(a => a.RestMorphWeights = new float[1]), "RestMorphWeights");
      Expect.Throws<ArgumentNullException>(() => Changed(a => a.Bones[0] = null), "Bones[0]");
      SunderException sum = Expect.Fails(() => Changed(a => a.Meshes[0].Influences[2].Weight = 0.5f), Status.WeightsNotNormalized, "weights_not_normalized");
      Expect.Equal(sum.Index, (uint?)2, "index");
      Expect.Fails(() => Changed(a => a.Meshes[0].Triangles[1] = 3), Status.IndexOutOfRange);
      Changed(a => { }).Dispose();
    }

    /// <summary>One triangle on one bone.</summary>
    static Character Changed(Action<CharacterArrays> change)
    {
      BoneTransform rest = new BoneTransform();
      rest.Rotation.W = 1;
      rest.Scale = new Vector3f(1, 1, 1);
      Influence whole = new Influence { Weight = 1 };
      CharacterArrays arrays = new CharacterArrays {
        Bones = new[] { new BoneArrays { Name = "root", Rest = rest } },
        Skins = new[] { new SkinArrays { Bones = new uint[1], BoneFromBind = new float[] { 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0 } } },
        Meshes = new[] { new MeshArrays {
          Positions = new float[] { 0, 0, 0, 1, 0, 0, 0, 1, 0 }, FirstInfluence = new uint[] { 0, 1, 2, 3 },
          Influences = new[] { whole, whole, whole }, Triangles = new uint[] { 0, 1, 2 } } } };
      change(arrays);
      return Character.FromArrays(arrays);
    }

    /// <summary>A glTF text with a buffer in another file, which a reader gives; what a reader throws becomes a failure.</summary>
    internal static void FileReaders()
    {
      byte[] text = System.Text.Encoding.UTF8.GetBytes("{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0}],"
        + "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}],\"buffers\":[{\"uri\":\"points.bin\",\"byteLength\":36}],"
        + "\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\","
        + "\"min\":[0,0,0],\"max\":[1,1,0]}]}");
      byte[] points = new byte[36];
      Buffer.BlockCopy(new float[] { 0, 0, 0, 1, 0, 0, 0, 1, 0 }, 0, points, 0, 36);
      string asked = null;
      using (Character character = Character.FromGlb(text, false, uri => { asked = uri; return points; }))
        Expect.Equal(character.GetMesh(0).Positions[3], 1f, "a position from the other file");
      Expect.Equal(asked, "points.bin", "the file that was asked for");
      Expect.Fails(() => Character.FromGlb(text, false, uri => { throw new IOException(); }), Status.FileNotFound);
      Expect.Fails(() => Character.FromGlb(text, false, uri => null), Status.FileNotFound);
      Expect.Fails(() => Character.FromGlb(text), Status.PathNotAllowed);
    }
  }
}
