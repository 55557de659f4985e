#include "io/collada/scene.h"

#include <algorithm>
#include <map>
#include <sstream>
#include <stdexcept>
#include <tinyxml2.h>
#include <unordered_map>
#include <utility>

namespace sunder::collada {
namespace {

using tinyxml2::XMLElement;

std::string attribute(const XMLElement& element, const char* name) {
  const char* const value = element.Attribute(name);
  return value == nullptr ? std::string() : value;
}

/// The id in "#id".
std::string id_of(const std::string& reference) {
  return reference.starts_with('#') ? reference.substr(1) : std::string();
}

std::string text_of(const XMLElement& element) {
  const char* const text = element.GetText();
  return text == nullptr ? std::string() : text;
}

std::vector<std::string> words(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> found;
  for (std::string word; stream >> word;) found.push_back(word);
  return found;
}

template <class Visit>
void visit_children(const XMLElement& element, const char* tag, const Visit& visit) {
  for (const XMLElement* child = element.FirstChildElement(tag); child != nullptr;
       child = child->NextSiblingElement(tag))
    visit(*child);
}

const XMLElement* child_with(const XMLElement& element, const char* tag, const char* name,
                             const std::string& value) {
  const XMLElement* found = nullptr;
  visit_children(element, tag, [&](const XMLElement& child) {
    if (found == nullptr && attribute(child, name) == value) found = &child;
  });
  return found;
}

class Reader {
 public:
  explicit Reader(const XMLElement& root) : root_(root) {}

  Scene read() {
    visit_children(root_, "library_controllers", [&](const XMLElement& library) {
      visit_children(library, "controller",
                     [&](const XMLElement& controller) { read_controller(controller); });
    });
    read_nodes(visual_scene());
    for (const auto& [skin, reference] : skeletons_)
      if (const auto node = node_of_id_.find(reference); node != node_of_id_.end())
        scene_.nodes[skin.first].skins[skin.second].skeletons.push_back(node->second);
    return std::move(scene_);
  }

 private:
  /// The visual scene that the file shows, or its first.
  const XMLElement& visual_scene() const {
    const XMLElement* const shown = root_.FirstChildElement("scene");
    const XMLElement* const instance =
        shown == nullptr ? nullptr : shown->FirstChildElement("instance_visual_scene");
    const std::string id = instance == nullptr ? "" : id_of(attribute(*instance, "url"));
    const XMLElement *first = nullptr, *named = nullptr;
    visit_children(root_, "library_visual_scenes", [&](const XMLElement& library) {
      if (first == nullptr) first = library.FirstChildElement("visual_scene");
      if (named == nullptr) named = child_with(library, "visual_scene", "id", id);
    });
    if (first == nullptr) throw std::runtime_error("there is no visual scene");
    return named == nullptr ? *first : *named;
  }

  void read_controller(const XMLElement& controller) {
    const XMLElement* const skin = controller.FirstChildElement("skin");
    const XMLElement* const joints = skin == nullptr ? nullptr : skin->FirstChildElement("joints");
    const XMLElement* const input =
        joints == nullptr ? nullptr : child_with(*joints, "input", "semantic", "JOINT");
    const XMLElement* const source =
        input == nullptr ? nullptr
                         : child_with(*skin, "source", "id", id_of(attribute(*input, "source")));
    if (source == nullptr) return;
    SkinInstance found;
    const XMLElement* array = source->FirstChildElement("Name_array");
    if (array == nullptr) {
      found.has_ids = true;
      array = source->FirstChildElement("IDREF_array");
    }
    if (array == nullptr) return;
    found.joints = words(text_of(*array));
    skin_of_controller_.emplace(attribute(controller, "id"), std::move(found));
  }

  /// Walks without recursion: files may nest nodes as deep as the parser allows.
  void read_nodes(const XMLElement& visual_scene) {
    struct Pending {
      const XMLElement* element;
      std::uint32_t parent;
    };
    std::vector<Pending> pending = {{&visual_scene, kNone}};
    while (!pending.empty()) {
      const Pending next = pending.back();
      pending.pop_back();
      const std::uint32_t index = add_node(*next.element);
      if (next.parent != kNone) scene_.nodes[next.parent].children.push_back(index);
      const std::size_t first = pending.size();
      visit_children(*next.element, "node", [&](const XMLElement& child) {
        pending.push_back({&child, index});
      });
      std::reverse(pending.begin() + static_cast<std::ptrdiff_t>(first), pending.end());
    }
  }

  std::uint32_t add_node(const XMLElement& element) {
    const auto index = static_cast<std::uint32_t>(scene_.nodes.size());
    Node node{
        attribute(element, "id"), attribute(element, "sid"), attribute(element, "name"), {}, {}};
    node_of_id_.emplace(node.id, index);
    visit_children(element, "instance_controller", [&](const XMLElement& instance) {
      const auto skin = skin_of_controller_.find(id_of(attribute(instance, "url")));
      if (skin == skin_of_controller_.end()) return;
      visit_children(instance, "skeleton", [&](const XMLElement& skeleton) {
        for (const std::string& reference : words(text_of(skeleton)))
          skeletons_.push_back({{index, node.skins.size()}, id_of(reference)});
      });
      node.skins.push_back(skin->second);
    });
    scene_.nodes.push_back(std::move(node));
    return index;
  }

  const XMLElement& root_;
  Scene scene_;
  std::map<std::string, SkinInstance> skin_of_controller_;
  std::map<std::string, std::uint32_t> node_of_id_;
  /// Node and number of a skin, and the id of one of its skeletons.
  std::vector<std::pair<std::pair<std::uint32_t, std::size_t>, std::string>> skeletons_;
};

}  // namespace

Scene read_scene(std::string_view text) {
  tinyxml2::XMLDocument document;
  if (document.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS)
    throw std::runtime_error(document.ErrorName());
  if (document.RootElement() == nullptr) throw std::runtime_error("there is no element");
  return Reader(*document.RootElement()).read();
}

std::vector<std::uint32_t> find_joints(const Scene& scene, const SkinInstance& skin) {
  std::unordered_map<std::string_view, std::uint32_t> node_of_name;
  if (skin.has_ids) {
    for (std::uint32_t node = 0; node < scene.nodes.size(); ++node)
      node_of_name.emplace(scene.nodes[node].id, node);
  } else {
    std::vector<std::uint32_t> queue = skin.skeletons;
    if (queue.empty()) queue.push_back(0);
    std::vector<bool> is_known(scene.nodes.size(), false);
    for (std::size_t i = 0; i < queue.size(); ++i) {
      if (is_known[queue[i]]) continue;
      is_known[queue[i]] = true;
      const Node& node = scene.nodes[queue[i]];
      if (!node.sid.empty()) node_of_name.emplace(node.sid, queue[i]);
      queue.insert(queue.end(), node.children.begin(), node.children.end());
    }
  }
  std::vector<std::uint32_t> nodes;
  for (const std::string& joint : skin.joints) {
    const auto found = node_of_name.find(joint);
    nodes.push_back(found == node_of_name.end() ? kNone : found->second);
  }
  return nodes;
}

}  // namespace sunder::collada
