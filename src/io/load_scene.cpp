// SPDX-License-Identifier: Apache-2.0
#include "resect/files.hpp"

#include "io/file.hpp"
#include "io/read_vtu.hpp"
#include "io/refuse.hpp"
#include "io/scene_text.hpp"

namespace resect {

namespace {

/// Builds what a scene names; paths count from the folder of the scene file.
struct Build {
    const std::string& scene_file;

    Result<Body> operator()(const LiverSource& source) const { return make_liver(source.lattice); }
    Result<Body> operator()(const KidneySource& source) const { return make_kidney(source.lattice); }
    Result<Body> operator()(const BlockSource& source) const {
        return make_block(source.size, source.cells, source.split);
    }
    Result<Body> operator()(const FileSource& source) const {
        return load_body(beside(scene_file, source.path));
    }
};

/// Nothing for an empty name.
std::vector<Vec3> read_motion(const std::string& mesh_file, const std::string& array,
                              const std::string& where) {
    if (array.empty()) { return {}; }
    return value_or_refuse(read_vtu_vectors(mesh_file, array), where);
}

std::vector<Vec3> stretch_about_origin(const std::vector<Vec3>& nodes, const Vec3& stretch) {
    std::vector<Vec3> displacement;
    displacement.reserve(nodes.size());
    for (const Vec3& p : nodes) {
        displacement.push_back({(stretch[0] - 1) * p[0], (stretch[1] - 1) * p[1], (stretch[2] - 1) * p[2]});
    }
    return displacement;
}

Motion read_initial(const std::string& scene_file, const SceneDescription& description) {
    const auto* source = std::get_if<FileSource>(&description.mesh);
    if (source == nullptr) { return {}; }
    const std::string mesh_file = beside(scene_file, source->path);
    const std::string where = scene_file + ": tissue.initial: ";
    return {read_motion(mesh_file, description.initial_displacement, where),
            read_motion(mesh_file, description.initial_velocity, where)};
}

Scene build_scene(const std::string& path, std::span<const std::string> overrides) {
    SceneDescription description = value_or_refuse(parse_scene(read_file(path), path, overrides));
    Scene scene = std::move(description.scene);
    scene.setup.body = value_or_refuse(std::visit(Build{path}, description.mesh), path + ": tissue.mesh: ");
    scene.setup.initial = read_initial(path, description);
    if (description.initial_stretch != Vec3{1, 1, 1}) {
        scene.setup.initial.displacement =
            stretch_about_origin(scene.setup.body.elements.nodes, description.initial_stretch);
    }
    return scene;
}

} // namespace

Result<Scene> load_scene(const std::string& path, std::span<const std::string> overrides) {
    return read_or_refuse([&] { return build_scene(path, overrides); });
}

} // namespace resect
