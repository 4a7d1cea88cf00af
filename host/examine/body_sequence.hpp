#pragma once
#include <string>
#include <vector>

#include "host/examine/file_mesh.hpp"
#include "host/examine/mesh_edges.hpp"
#include "io/finding.hpp"
#include "io/mesh/mesh_obj.hpp"
#include "io/scene/scene.hpp"

namespace selvage {

/// Tells of numbers that are missing between the files of a sequence, and of files without a number among others.
/// @param files  in the order in which they are taken
/// @param place  of the key, for messages
void examine_file_numbers(const std::vector<SequenceFile>& files, const InputPlace& place,
                          std::vector<Finding>& findings);

/// Reads the poses of a body one after the other and compares each with the one before: the same faces, about the same
/// size, neighbours that stay neighbours, the same side outside.
class PoseLoader {
public:
    /// @param start  as load_body returned it; it must outlive this object
    PoseLoader(const Scene& scene, int index, const FileMesh& start);

    /// Returns the vertices of the next pose, numbered as those of the start [m].
    /// @throws InputError for other faces, and for a pose that is many times larger or smaller than the one before,
    ///         flat, inside out or has its vertices in another order
    std::vector<Vec3> load(const std::string& file);

    /// Adds what was found in all poses.
    void conclude(std::vector<Finding>& findings) const;

private:
    void require_same_faces(const ObjMesh& pose) const;
    void judge(const ObjMesh& pose, const std::vector<Vec3>& vertices);
    void judge_neighbours(const ObjMesh& pose, const std::vector<Vec3>& vertices, double scale);
    void note_way(const ObjMesh& pose, const std::vector<Vec3>& vertices);
    void note_crossings(const ObjMesh& pose, const std::vector<Vec3>& vertices);

    const Scene& scene_;
    int index_;
    const FileMesh& start_;
    std::vector<FaceSide> edges_;  ///< One side of each.
    Pieces pieces_;
    std::string last_file_;
    std::vector<Vec3> last_;
    std::vector<Finding> findings_;
    Finding crossings_;
    int crossed_ = 0, poses_ = 0;
};

}  // namespace selvage
