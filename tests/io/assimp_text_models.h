#pragma once

#include <string>

namespace sunder::test {

/// A unit square of two triangles in each text format.
inline constexpr const char* kSquareObj =
    "mtllib square.mtl\nusemtl red\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 "
    "0.75\nvt 0 1\nf 1/1 2/2 3/3 4/4\n";
inline constexpr const char* kSquareMtl = "newmtl red\nKd 0.5 0.25 0.125\n";
inline constexpr const char* kSquareOff =
    "OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n3 0 2 3\n";
/// Vertices 0 and 4, 2 and 5 coincide: an open tear along the diagonal. Vertices of one lip are
/// shared, so the lips stay apart.
inline constexpr const char* kTornPly =
    "ply\nformat ascii 1.0\nelement vertex 7\nproperty float x\nproperty float y\nproperty float "
    "z\nelement face 3\n"
    "property list uchar int vertex_indices\nend_header\n"
    "0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 0\n1 1 0\n2 0 0\n3 0 1 2\n3 4 5 3\n3 1 6 2\n";

/// A strip of two quads along y, skinned to two bones in a chain, the upper one rotated by 90
/// degrees about z within one second. (Every number has a decimal point: assimp reads "1,0" as
/// 1.0.)
inline const std::string kSkinnedX = R"(xof 0303txt 0032
AnimTicksPerSecond { 10; }
Frame Root {
  FrameTransformMatrix { 1.0,0.0,0.0,0.0, 0.0,1.0,0.0,0.0, 0.0,0.0,1.0,0.0, 0.0,0.0,0.0,1.0;; }
  Frame Lower {
    FrameTransformMatrix { 1.0,0.0,0.0,0.0, 0.0,1.0,0.0,0.0, 0.0,0.0,1.0,0.0, 0.0,0.0,0.0,1.0;; }
    Frame Upper {
      FrameTransformMatrix { 1.0,0.0,0.0,0.0, 0.0,1.0,0.0,0.0, 0.0,0.0,1.0,0.0, 0.0,1.0,0.0,1.0;; }
    }
  }
  Frame Strip {
    FrameTransformMatrix { 1.0,0.0,0.0,0.0, 0.0,1.0,0.0,0.0, 0.0,0.0,1.0,0.0, 0.0,0.0,0.0,1.0;; }
    Mesh StripMesh {
      6;
      0;0;0;, 1;0;0;, 0;1;0;, 1;1;0;, 0;2;0;, 1;2;0;;
      4;
      3;0,2,1;, 3;1,2,3;, 3;2,4,3;, 3;3,4,5;;
      XSkinMeshHeader { 2; 4; 2; }
      SkinWeights { "Lower"; 4; 0,1,2,3; 1.0,1.0,0.5,0.5; 1.0,0.0,0.0,0.0, 0.0,1.0,0.0,0.0, 0.0,0.0,1.0,0.0, 0.0,0.0,0.0,1.0;; }
      SkinWeights { "Upper"; 4; 2,3,4,5; 0.5,0.5,1.0,1.0; 1.0,0.0,0.0,0.0, 0.0,1.0,0.0,0.0, 0.0,0.0,1.0,0.0, 0.0,-1.0,0.0,1.0;; }
    }
  }
}
AnimationSet Bend {
  Animation {
    { Upper }
    AnimationKey { 0; 2; 0;4;1.0,0.0,0.0,0.0;;, 10;4;0.70710678,0.0,0.0,0.70710678;;; }
    AnimationKey { 2; 1; 0;3;0.0,1.0,0.0;;; }
  }
}
)";

/// One triangle on six bones, all of which move vertex 0 with a weight sum of 1.2; in centimetres
/// and z up.
inline const std::string kSixBoneCollada = [] {
  std::string joints, nodes, binds;
  for (int i = 0; i < 6; ++i) {
    const std::string name = "bone" + std::to_string(i);
    joints += (i > 0 ? " " : "") + name;
    nodes += "<node id='" + name + "' sid='" + name + "' name='" + name +
             "' type='JOINT'><matrix sid='transform'>1 0 0 " + std::to_string(i) +
             " 0 1 0 0 0 0 1 0 0 0 0 1</matrix></node>";
    binds += "1 0 0 -" + std::to_string(i) + " 0 1 0 0 0 0 1 0 0 0 0 1 ";
  }
  return R"(<?xml version="1.0" encoding="utf-8"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><created>2020-01-01T00:00:00</created><modified>2020-01-01T00:00:00</modified><unit name="centimeter" meter="0.01"/><up_axis>Z_UP</up_axis></asset>
<library_geometries><geometry id="geo" name="Sail"><mesh>
<source id="pos"><float_array id="pos-a" count="9">0 0 0 100 0 0 0 0 100</float_array><technique_common><accessor source="#pos-a" count="3" stride="3"><param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="vert"><input semantic="POSITION" source="#pos"/></vertices>
<triangles count="1"><input semantic="VERTEX" source="#vert" offset="0"/><p>0 1 2</p></triangles>
</mesh></geometry></library_geometries>
<library_controllers><controller id="ctl"><skin source="#geo"><bind_shape_matrix>1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1</bind_shape_matrix>
<source id="jn"><Name_array id="jn-a" count="6">)" +
         joints +
         R"(</Name_array><technique_common><accessor source="#jn-a" count="6" stride="1"><param name="JOINT" type="name"/></accessor></technique_common></source>
<source id="ib"><float_array id="ib-a" count="96">)" +
         binds +
         R"(</float_array><technique_common><accessor source="#ib-a" count="6" stride="16"><param name="TRANSFORM" type="float4x4"/></accessor></technique_common></source>
<source id="w"><float_array id="w-a" count="2">0.2 1.0</float_array><technique_common><accessor source="#w-a" count="2" stride="1"><param name="WEIGHT" type="float"/></accessor></technique_common></source>
<joints><input semantic="JOINT" source="#jn"/><input semantic="INV_BIND_MATRIX" source="#ib"/></joints>
<vertex_weights count="3"><input semantic="JOINT" source="#jn" offset="0"/><input semantic="WEIGHT" source="#w" offset="1"/><vcount>6 1 1</vcount><v>0 0 1 0 2 0 3 0 4 0 5 0 1 1 2 1</v></vertex_weights>
</skin></controller></library_controllers>
<library_visual_scenes><visual_scene id="scene">)" +
         nodes +
         R"(<node id="sail" name="Sail"><instance_controller url="#ctl"><skeleton>#bone0</skeleton></instance_controller></node>
</visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#scene"/></scene>
</COLLADA>
)";
}();

}  // namespace sunder::test
