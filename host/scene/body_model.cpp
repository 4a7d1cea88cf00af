#include "host/scene/body_model.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "host/examine/body_mesh.hpp"
#include "host/examine/body_sequence.hpp"
#include "host/mannequin/mannequin.hpp"
#include "host/model/body.hpp"
#include "host/scene/body_shapes.hpp"
#include "io/mesh/mesh_obj.hpp"

namespace selvage {
namespace {

constexpr double degrees_per_pose = 4;  // a straight way between two poses shortens an arm by 0.06 % of its length

// A mannequin whose size is not given has that of the garment which it wears.
BodySize size_of(const Scene& scene, int index)
{
    const bool given = scene.places.contains(fmt::format("body[{}].size", index));
    return !given && scene.places.contains("garment.size") ? scene.garment.size : scene.bodies[index].size;
}

MannequinMeasures body_measures(const Scene& scene, int index, const InputPlace& place)
{
    const BodyScene& body = scene.bodies[index];
    MannequinMeasures measures = mannequin_size(size_of(scene, index), body.figure, place);
    const auto take = [](double& to, double given) {
        if (!std::isnan(given)) to = given;
    };
    take(measures.stature, body.stature);
    take(measures.bust, body.bust);
    take(measures.waist, body.waist);
    take(measures.hips, body.hips);
    take(measures.shoulder_width, body.shoulder_width);
    take(measures.neck, body.neck);
    take(measures.arm_length, body.arm_length);
    take(measures.arm_angle, body.arm_angle);
    return measures;
}

// Poses between two angles: the angle changes as the scene says, the arm's points go straight from pose to pose.
void add_arm_poses(const TriangleMesh& start, const MannequinMeasures& measures, const BodyScene& body,
                   std::vector<LoadedPose>& poses)
{
    double time = 0, angle = measures.arm_angle;
    for (const KeyframeScene& key : body.keyframes) {
        const double next = std::isnan(key.arm_angle) ? angle : key.arm_angle;
        const int count = std::max(1, int(std::ceil(std::abs(next - angle) / degrees_per_pose)));
        for (int k = 1; k <= count; ++k) {
            const double s = double(k) / count,
                         part = body.interpolation == Interpolation::smooth ? s * s * (3 - 2 * s) : s;
            poses.push_back({time + s * (key.time - time),
                             mannequin_with_arms(start, measures, angle + part * (next - angle)), false});
        }
        time = key.time;
        angle = next;
    }
}

std::vector<LoadedPose> mannequin_poses(const TriangleMesh& start, const MannequinMeasures& measures,
                                        const BodyScene& body)
{
    std::vector<LoadedPose> poses;
    const bool raises = std::any_of(body.keyframes.begin(), body.keyframes.end(),
                                    [](const KeyframeScene& key) { return !std::isnan(key.arm_angle); });
    if (raises) add_arm_poses(start, measures, body, poses);
    return poses;
}

std::vector<LoadedPose> mesh_poses(const Scene& scene, int index, const FileMesh& start,
                                   const std::vector<SequenceFile>& sequence, std::vector<Finding>& findings)
{
    const BodyScene& body = scene.bodies[index];
    std::vector<LoadedPose> poses;
    PoseLoader loader(scene, index, start);
    for (std::size_t k = 0; k < sequence.size(); ++k) {
        const double time = body.sequence_start + double(k) / body.sequence_rate;
        if (time > 0) poses.push_back({time, loader.load(sequence[k].path), false});
    }
    const bool morphs = std::any_of(body.keyframes.begin(), body.keyframes.end(),
                                    [](const KeyframeScene& key) { return !key.mesh.empty(); });
    for (const KeyframeScene& key : body.keyframes) {
        if (!morphs) break;
        const std::vector<Vec3>& last = poses.empty() ? start.mesh.vertices : poses.back().vertices;
        std::vector<Vec3> next = key.mesh.empty() ? last : loader.load(scene.resolve(key.mesh));
        poses.push_back({key.time, std::move(next), body.interpolation == Interpolation::smooth});
    }
    loader.conclude(findings);
    return poses;
}

Body mesh_body(const Scene& scene, int index, std::vector<Finding>& findings)
{
    const BodyScene& body = scene.bodies[index];
    std::vector<SequenceFile> sequence;
    if (!body.sequence.empty()) {
        const InputPlace place = scene.place(fmt::format("body[{}].sequence", index));
        sequence = sequence_files(scene.resolve(body.sequence), place);
        examine_file_numbers(sequence, place, findings);
    }
    const std::string file = body.mesh.empty() ? sequence.front().path : scene.resolve(body.mesh);
    const FileMesh loaded = load_body(scene, index, file, findings);
    Body made = make_body(body, scene, index, loaded.mesh);
    if (body.moves()) add_motion(made, body, mesh_poses(scene, index, loaded, sequence, findings));
    return made;
}

Body mannequin_body(const Scene& scene, int index)
{
    const BodyScene& body = scene.bodies[index];
    const InputPlace place = scene.place(fmt::format("body[{}]", index));
    const MannequinMeasures measures = body_measures(scene, index, place);
    const TriangleMesh mannequin = make_mannequin(measures, place);
    Body made = make_body(body, scene, index, mannequin);
    add_motion(made, body, mannequin_poses(mannequin, measures, body));
    return made;
}

}  // namespace

std::vector<Body> build_bodies(const Scene& scene, std::vector<Finding>& findings)
{
    std::vector<Body> bodies;
    for (int i = 0; i < int(scene.bodies.size()); ++i) {
        const BodyScene& body = scene.bodies[i];
        if (body.shape == BodyShape::mannequin) {
            bodies.push_back(mannequin_body(scene, i));
        } else if (body.shape == BodyShape::mesh) {
            bodies.push_back(mesh_body(scene, i, findings));
        } else {
            bodies.push_back(make_body(body, scene, i));
            add_motion(bodies.back(), body, {});
        }
    }
    return bodies;
}

}  // namespace selvage
