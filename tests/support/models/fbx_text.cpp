#include "support/models/fbx_text.h"

#include <cmath>
#include <cstdio>

namespace sunder::test {
namespace {

constexpr double kTicksPerSecond = 46186158000.0;

std::string number(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.17g", value);
  return text.data();
}
std::string ticks(double seconds) {
  return std::to_string(static_cast<long long>(std::llround(seconds * kTicksPerSecond)));
}

template <class Values, class Print>
std::string list(const Values& values, const Print& print) {
  std::string text;
  for (const auto& value : values) text += (text.empty() ? "" : ",") + print(value);
  return text;
}

template <class Values, class Print>
std::string array(const char* name, const Values& values, const Print& print) {
  return std::string("\t\t") + name + ": *" + std::to_string(values.size()) +
         " {\n\t\t\ta: " + list(values, print) + "\n\t\t}\n";
}

std::string vector_property(const char* name, const char* type, const Vec3d& value) {
  return std::string("\t\t\tP: \"") + name + "\", \"" + type + "\", \"\", \"A\"," +
         number(value.x()) + "," + number(value.y()) + "," + number(value.z()) + "\n";
}
std::string enum_property(const char* name, int value) {
  return std::string("\t\t\tP: \"") + name + "\", \"enum\", \"\", \"\"," + std::to_string(value) +
         "\n";
}

/// Writes objects and their connections; objects have numbers in the order of their writing.
class Writer {
 public:
  explicit Writer(const FbxFile& file) : file_(file) {}

  std::string write() {
    for (const FbxModel& model : file_.models) add_model(model);
    for (const FbxTake& take : file_.takes) add_take(take);
    return "; FBX 7.4.0 project file\nFBXHeaderExtension:  {\n\tFBXHeaderVersion: 1003\n"
           "\tFBXVersion: 7400\n}\nGlobalSettings:  {\n\tVersion: 1000\n\tProperties70:  {\n"
           "\t\tP: \"UpAxis\", \"int\", \"Integer\", \"\",1\n"
           "\t\tP: \"UpAxisSign\", \"int\", \"Integer\", \"\",1\n"
           "\t\tP: \"FrontAxis\", \"int\", \"Integer\", \"\",2\n"
           "\t\tP: \"FrontAxisSign\", \"int\", \"Integer\", \"\",1\n"
           "\t\tP: \"CoordAxis\", \"int\", \"Integer\", \"\",0\n"
           "\t\tP: \"CoordAxisSign\", \"int\", \"Integer\", \"\",1\n"
           "\t\tP: \"UnitScaleFactor\", \"double\", \"Number\", \"\",100\n\t}\n}\n"
           "Objects:  {\n" +
           objects_ + "}\nConnections:  {\n" + connections_ + "}\n";
  }

 private:
  void connect(const std::string& source, const std::string& target,
               const std::string& property = "") {
    connections_ += (property.empty() ? "\tC: \"OO\"," : "\tC: \"OP\",") + source + "," + target +
                    (property.empty() ? "" : ", \"" + property + "\"") + "\n";
  }
  std::string begin(const char* type, const std::string& prefix, const std::string& name,
                    const char* kind) {
    const std::string id = std::to_string(next_++);
    objects_ += std::string("\t") + type + ": " + id + ", \"" + prefix + "::" + name + "\", \"" +
                kind + "\" {\n";
    return id;
  }

  void add_model(const FbxModel& model) {
    const std::string id = begin("Model", "Model", model.name, "Mesh");
    objects_ +=
        "\t\tVersion: 232\n\t\tProperties70:  {\n"
        "\t\t\tP: \"RotationActive\", \"bool\", \"\", \"\",1\n" +
        enum_property("RotationOrder", model.rotation_order) +
        enum_property("InheritType", model.inherit_type) +
        vector_property("Lcl Translation", "Lcl Translation", model.translation) +
        vector_property("Lcl Rotation", "Lcl Rotation", model.rotation) +
        vector_property("Lcl Scaling", "Lcl Scaling", model.scaling) +
        vector_property("PreRotation", "Vector3D", model.pre_rotation) +
        vector_property("PostRotation", "Vector3D", model.post_rotation) +
        vector_property("RotationOffset", "Vector3D", model.rotation_offset) +
        vector_property("RotationPivot", "Vector3D", model.rotation_pivot) +
        vector_property("ScalingOffset", "Vector3D", model.scaling_offset) +
        vector_property("ScalingPivot", "Vector3D", model.scaling_pivot) + "\t\t}\n\t}\n";
    connect(id, model.parent == kNone ? "0" : model_ids_[model.parent]);
    model_ids_.push_back(id);
    const std::string geometry = begin("Geometry", "Geometry", model.name, "Mesh");
    std::vector<double> coordinates;
    for (const Vec3d& corner : model.triangle)
      coordinates.insert(coordinates.end(), corner.data(), corner.data() + 3);
    objects_ += array("Vertices", coordinates, number) +
                array("PolygonVertexIndex", std::array{0, 1, -3},
                      [](int index) { return std::to_string(index); }) +
                "\t\tGeometryVersion: 124\n\t}\n";
    connect(geometry, id);
  }

  void add_take(const FbxTake& take) {
    const std::string stack = begin("AnimationStack", "AnimStack", take.name, "");
    if (take.start != 0.0 || take.stop != 0.0)
      objects_ += "\t\tProperties70:  {\n\t\t\tP: \"LocalStart\", \"KTime\", \"Time\", \"\"," +
                  ticks(take.start) + "\n\t\t\tP: \"LocalStop\", \"KTime\", \"Time\", \"\"," +
                  ticks(take.stop) + "\n\t\t}\n";
    objects_ += "\t}\n";
    const std::string layer = begin("AnimationLayer", "AnimLayer", "Base", "");
    objects_ += "\t}\n";
    connect(layer, stack);
    for (const FbxMotion& motion : take.motions) {
      const FbxModel& model = file_.models[motion.model];
      add_curves(motion, motion.translation, model.translation, "T", "Lcl Translation", layer);
      add_curves(motion, motion.rotation, model.rotation, "R", "Lcl Rotation", layer);
      add_curves(motion, motion.scaling, model.scaling, "S", "Lcl Scaling", layer);
    }
  }

  void add_curves(const FbxMotion& motion, const std::array<FbxCurve, 3>& curves, const Vec3d& rest,
                  const char* name, const char* property, const std::string& layer) {
    if (curves[0].empty() && curves[1].empty() && curves[2].empty()) return;
    const std::string node = begin("AnimationCurveNode", "AnimCurveNode", name, "");
    objects_ += "\t\tProperties70:  {\n";
    constexpr std::array kAxes = {"d|X", "d|Y", "d|Z"};
    for (int axis = 0; axis < 3; ++axis)
      objects_ += std::string("\t\t\tP: \"") + kAxes[static_cast<std::size_t>(axis)] +
                  "\", \"Number\", \"\", \"A\"," + number(rest[axis]) + "\n";
    objects_ += "\t\t}\n\t}\n";
    connect(node, layer);
    connect(node, model_ids_[motion.model], property);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (curves[axis].empty()) continue;
      const std::string curve = begin("AnimationCurve", "AnimCurve", "", "");
      objects_ +=
          "\t\tDefault: 0\n\t\tKeyVer: 4008\n" +
          array("KeyTime", curves[axis], [](const FbxKey& key) { return ticks(key.seconds); }) +
          array("KeyValueFloat", curves[axis],
                [](const FbxKey& key) { return number(key.value); }) +
          "\t\tKeyAttrFlags: *1 {\n\t\t\ta: 4\n\t\t}\n"
          "\t\tKeyAttrDataFloat: *4 {\n\t\t\ta: 0,0,0,0\n\t\t}\n"
          "\t\tKeyAttrRefCount: *1 {\n\t\t\ta: " +
          std::to_string(curves[axis].size()) + "\n\t\t}\n\t}\n";
      connect(curve, node, kAxes[axis]);
    }
  }

  const FbxFile& file_;
  std::string objects_, connections_;
  std::vector<std::string> model_ids_;
  int next_ = 1000;
};

}  // namespace

std::string fbx_text(const FbxFile& file) { return Writer(file).write(); }

}  // namespace sunder::test
