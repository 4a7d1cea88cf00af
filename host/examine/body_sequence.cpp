#include "host/examine/body_sequence.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <numeric>

#include <fmt/format.h>
#include <Eigen/Geometry>
#include <Eigen/SVD>

#include "host/examine/body_mesh.hpp"
#include "host/examine/body_pieces.hpp"

namespace selvage {
namespace {

// Between one pose and the next. Chosen by hand, far from what a body that moves does.
struct PoseLimits {
    static constexpr double most_growth = 10;    // of the size, refused; and its inverse
    static constexpr double much_growth = 2;     // told; and its inverse
    static constexpr double edge_growth = 4;     // of an edge, against that of the whole
    static constexpr double edges_beyond = 0.1;  // part of the edges with which the vertices count as permuted
    static constexpr double mean_growth = 3;     // of the edges in the middle: the same
    static constexpr double flat = 1e-3;         // of the volume
    static constexpr double way = 2;             // of the centre, in sizes
    static constexpr double turn = 60;           // [degrees]
};

std::string name_of(const std::string& path) { return std::filesystem::path(path).filename().string(); }

Vec3 centre_of(const std::vector<Vec3>& points)
{
    return std::accumulate(points.begin(), points.end(), Vec3(Vec3::Zero())) / double(points.size());
}

// Root mean square of the distances from the centre, which does not depend on the order of the points.
double radius_of(const std::vector<Vec3>& points)
{
    const Vec3 centre = centre_of(points);
    double sum = 0;
    for (const Vec3& x : points) sum += (x - centre).squaredNorm();
    return std::sqrt(sum / double(points.size()));
}

// Angle of the rotation that takes one set of points best into another (Kabsch 1976) [degrees].
double turn_between(const std::vector<Vec3>& from, const std::vector<Vec3>& to)
{
    const Vec3 a = centre_of(from), b = centre_of(to);
    Mat3 covariance = Mat3::Zero();
    for (std::size_t k = 0; k < from.size(); ++k) covariance += (to[k] - b) * (from[k] - a).transpose();
    const Eigen::JacobiSVD<Mat3> svd(covariance, Eigen::ComputeFullU | Eigen::ComputeFullV);
    // A body that is thin along an axis may be mirrored along it for less than it takes to turn; only turns count.
    const double handed = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0 ? -1 : 1;
    const Mat3 turn = svd.matrixU() * Vec3(1, 1, handed).asDiagonal() * svd.matrixV().transpose();
    return std::acos(std::clamp(0.5 * (turn.trace() - 1), -1.0, 1.0)) * 180 / std::numbers::pi;
}

}  // namespace

void examine_file_numbers(const std::vector<SequenceFile>& files, const InputPlace& place,
                          std::vector<Finding>& findings)
{
    std::vector<SequenceFile> numbered;
    for (const SequenceFile& file : files)
        if (file.number >= 0) numbered.push_back(file);
    if (numbered.empty()) return;
    if (numbered.size() < files.size())
        findings.push_back({"sequence_order", place,
                            fmt::format("`{}` and others without a number stand after those with one",
                                        name_of(files[numbered.size()].path)),
                            "number all poses, or leave these out by the pattern of the names"});
    long long step = 0, missing = 0;
    std::size_t first = 0;
    for (std::size_t k = 1; k < numbered.size(); ++k) {
        const long long way = numbered[k].number - numbered[k - 1].number;
        step = step == 0 ? way : std::min(step, way);
    }
    for (std::size_t k = 1; k < numbered.size(); ++k)
        if (const long long left_out = (numbered[k].number - numbered[k - 1].number) / step - 1; left_out > 0) {
            if (missing == 0) first = k;
            missing += left_out;
        }
    if (missing > 0)
        findings.push_back(
            {"sequence_gap", place,
             fmt::format("{} missing, the first between `{}` and `{}`: these are taken as if they followed "
                         "each other, and what comes after is early",
                         counted(missing, "pose is", "poses are"), name_of(numbered[first - 1].path),
                         name_of(numbered[first].path)),
             "add the files, or number the poses anew"});
}

PoseLoader::PoseLoader(const Scene& scene, int index, const FileMesh& start)
    : scene_(scene), index_(index), start_(start), last_file_(start.file()), last_(start.mesh.vertices)
{
    const std::vector<FaceSide> sides = sorted_sides(start.mesh.faces);
    for_each_edge(sides, [&](const FaceSide* first, const FaceSide*) { edges_.push_back(*first); });
    pieces_ = pieces_by_edges(sides, start.mesh.faces.size());
}

void PoseLoader::require_same_faces(const ObjMesh& pose) const
{
    const ObjMesh& own = start_.obj;
    const bool same = pose.vertices.size() == own.vertices.size() && pose.polygon_starts == own.polygon_starts &&
                      pose.corner_vertices == own.corner_vertices;
    if (same) return;
    int line = 0;
    for (int p = 0; p < std::min(pose.polygon_count(), own.polygon_count()) && line == 0; ++p)
        if (!std::ranges::equal(pose.polygon(p), own.polygon(p))) line = pose.polygon_lines[p];
    throw InputError({pose.path, line, 0, {}},
                     fmt::format("a pose of {} vertices and {} faces{}", pose.vertices.size(), pose.polygon_count(),
                                 line > 0 ? ", this one other than in " + start_.file() : ""),
                     fmt::format("the {} vertices and the {} faces of the body's own mesh, numbered as there",
                                 own.vertices.size(), own.polygon_count()));
}

void PoseLoader::judge_neighbours(const ObjMesh& pose, const std::vector<Vec3>& vertices, double scale)
{
    std::vector<double> growth;
    growth.reserve(edges_.size());
    for (const FaceSide& edge : edges_)
        growth.push_back((vertices[edge.high] - vertices[edge.low]).norm() /
                         (scale * (last_[edge.high] - last_[edge.low]).norm()));
    const auto beyond = [](double g) { return g > PoseLimits::edge_growth; };
    const auto count = std::count_if(growth.begin(), growth.end(), beyond);
    const auto worst = std::max_element(growth.begin(), growth.end());
    const FaceSide& edge = edges_[std::size_t(worst - growth.begin())];
    const double most = *worst;
    std::nth_element(growth.begin(), growth.begin() + std::ptrdiff_t(growth.size() / 2), growth.end());
    const double middle = growth[growth.size() / 2];
    if (middle > PoseLimits::mean_growth || double(count) > PoseLimits::edges_beyond * double(growth.size()))
        throw InputError(
            {pose.path, 0, 0, {}},
            fmt::format("a pose whose vertices are in another order: neighbours are {:.3g} times as far "
                        "apart as in {}, vertices {} and {} even {:.3g} times",
                        middle, name_of(last_file_), start_.number(edge.low), start_.number(edge.high), most),
            "the vertices in the order of the pose before");
    if (count > 0)
        findings_.push_back(
            {"pose",
             {pose.path, pose.vertex_lines[start_.vertex_source[edge.low]], 0, {}},
             fmt::format("{} of the body more than {} times as long as in {}, most the one from vertex {} "
                         "to {}, {:.3g} times",
                         counted((long long)(count), "edge is", "edges are"), PoseLimits::edge_growth,
                         name_of(last_file_), start_.number(edge.low), start_.number(edge.high), most),
             "look for vertices that are exchanged or have jumped"});
}

// A pose that is elsewhere, or lies another way.
void PoseLoader::note_way(const ObjMesh& pose, const std::vector<Vec3>& vertices)
{
    const double way = (centre_of(vertices) - centre_of(last_)).norm(), extent = extent_of(last_);
    if (way > PoseLimits::way * extent)
        findings_.push_back({"pose",
                             {pose.path, 0, 0, {}},
                             fmt::format("the body jumps by {:.3g} m, {:.3g} times its own size, from {}", way,
                                         way / extent, name_of(last_file_)),
                             "check the origin of the pose"});
    if (const double turn = turn_between(last_, vertices); turn > PoseLimits::turn)
        findings_.push_back({"pose",
                             {pose.path, 0, 0, {}},
                             fmt::format("the body turns by {:.0f} degrees from {}", turn, name_of(last_file_)),
                             "check the up direction of the pose"});
}

void PoseLoader::judge(const ObjMesh& pose, const std::vector<Vec3>& vertices)
{
    const InputPlace place{pose.path, 0, 0, {}};
    const double scale = radius_of(vertices) / radius_of(last_);
    if (!(scale < PoseLimits::most_growth && scale > 1 / PoseLimits::most_growth))
        throw InputError(place, fmt::format("a pose that is {:.4g} times as large as {}", scale, name_of(last_file_)),
                         "poses of about one size; check the unit of this one");
    if (!(scale < PoseLimits::much_growth && scale > 1 / PoseLimits::much_growth))
        findings_.push_back({"pose", place,
                             fmt::format("the body becomes {:.3g} times as large as in {}", scale, name_of(last_file_)),
                             "check the unit of the pose"});
    judge_neighbours(pose, vertices, scale);
    const TriangleMesh now{vertices, start_.mesh.faces, {}}, before{last_, start_.mesh.faces, {}};
    const std::vector<double> volume = piece_volumes(now, pieces_), earlier = piece_volumes(before, pieces_);
    for (int p = 0; p < pieces_.count(); ++p) {
        const double part = volume[p] / (earlier[p] * std::pow(scale, 3));
        const std::string piece = pieces_.count() > 1 ? fmt::format("piece {} of ", p + 1) : std::string();
        if (std::abs(part) < PoseLimits::flat)
            throw InputError({pose.path, 0, 0, {}}, fmt::format("{}a pose that is flat", piece),
                             "a solid, as in the pose before");
        if (part < 0)
            throw InputError(
                {pose.path, 0, 0, {}},
                fmt::format("{}a pose that is inside out (mirrored) against {}", piece, name_of(last_file_)),
                "a pose with the same side outside; check its axes");
    }
    note_way(pose, vertices);
}

void PoseLoader::note_crossings(const ObjMesh& pose, const std::vector<Vec3>& vertices)
{
    FileMesh posed;
    posed.obj.path = pose.path;
    posed.obj.polygon_lines = pose.polygon_lines;
    posed.mesh = {vertices, start_.mesh.faces, {}};
    posed.face_polygons = start_.face_polygons;
    std::vector<Finding> found;
    find_body_crossings(posed, pieces_, found);
    std::erase_if(found, [](const Finding& finding) { return finding.severity == Severity::note; });
    if (found.empty()) return;
    if (crossed_++ == 0) crossings_ = found.front();
}

std::vector<Vec3> PoseLoader::load(const std::string& file)
{
    const ObjMesh pose = read_body(scene_.bodies[index_], file);
    require_same_faces(pose);
    std::vector<Vec3> vertices;
    vertices.reserve(start_.vertex_source.size());
    for (const int source : start_.vertex_source) vertices.push_back(pose.vertices[source]);
    judge(pose, vertices);
    std::vector<Finding> known;  // the start has told of a size that is unusual
    examine_body_size(scene_, index_, file, extent_of(vertices), known);
    const double least = least_area(vertices);
    for (std::size_t f = 0; f < start_.mesh.faces.size(); ++f)
        if (!(area_of(vertices, start_.mesh.faces[f]) > least))
            throw InputError({file, start_.line_of_face(pose, int(f)), 0, {}}, "a face without area in this pose",
                             "an area above 0 m^2");
    note_crossings(pose, vertices);
    last_file_ = file;
    last_ = vertices;
    ++poses_;
    return vertices;
}

void PoseLoader::conclude(std::vector<Finding>& findings) const
{
    append_findings(findings, findings_);
    if (crossed_ == 0) return;
    Finding finding = crossings_;
    finding.text =
        fmt::format("{} of {} poses intersect themselves; in the first of them {}", crossed_, poses_, finding.text);
    findings.push_back(finding);
}

}  // namespace selvage
