#include <algorithm>
#include <set>

#include "host/model/body.hpp"
#include "host/solver/contact/cloth_surface.hpp"
#include "validation/measure/crumpled_sheets.hpp"
#include "validation/unit/catch.hpp"

using namespace selvage;

namespace {

// The reach is below a quarter of the distance between the vertices and the opposite edges of a face.
constexpr double spacing = 0.02, reach = 0.15 * spacing;
constexpr int side = 9;

using Key = std::pair<bool, std::array<int, 4>>;

// Returns a key that does not depend on the order of the corners of a face or edge, or on the order of two edges.
Key key_of(PairCandidate c)
{
    if (c.edges) {
        std::sort(c.corner.begin(), c.corner.begin() + 2);
        std::sort(c.corner.begin() + 2, c.corner.end());
        if (std::pair(c.corner[2], c.corner[3]) < std::pair(c.corner[0], c.corner[1]))
            std::swap_ranges(c.corner.begin(), c.corner.begin() + 2, c.corner.begin() + 2);
    } else {
        std::sort(c.corner.begin() + 1, c.corner.end());
    }
    return {c.edges, c.corner};
}

// Sheets and bodies, with a list of all pairs of primitives that can be in contact.
struct Sheets {
    Cloth cloth;
    TreeSurface surface;
    std::vector<PairCandidate> all;
    int stride = 0;

    explicit Sheets(Cloth of, const std::vector<Body>& bodies = {}) : cloth(std::move(of))
    {
        surface = tree_surface(make_topology(cloth, false), cloth);
        add_bodies(surface, bodies);
        stride = padded_stride(int(cloth.positions.size()));
        list_all();
    }

    bool apart(const PairCandidate& c) const
    {
        const int first = c.edges ? 2 : 1;
        bool any_cloth = false;
        for (int v : c.corner) any_cloth = any_cloth || v >= 0;
        for (int i = 0; i < first; ++i)
            for (int j = first; j < 4; ++j)
                if (c.corner[i] == c.corner[j] || (c.corner[i] >= 0 && c.corner[j] >= 0 &&
                                                   surface.group_of[c.corner[i]] == surface.group_of[c.corner[j]]))
                    return false;
        return any_cloth;
    }

    void list_all()
    {
        std::set<int> vertices;
        std::set<std::array<int, 2>> edges;
        for (const Face& f : surface.faces)
            for (int k = 0; k < 3; ++k) {
                vertices.insert(f[k]);
                edges.insert({std::min(f[k], f[(k + 1) % 3]), std::max(f[k], f[(k + 1) % 3])});
            }
        const auto add = [this](const PairCandidate& c) {
            if (apart(c)) all.push_back(c);
        };
        for (int v : vertices)
            for (const Face& f : surface.faces) add({{v, f[0], f[1], f[2]}, false});
        for (auto a = edges.begin(); a != edges.end(); ++a)
            for (auto b = std::next(a); b != edges.end(); ++b) add({{(*a)[0], (*a)[1], (*b)[0], (*b)[1]}, true});
    }

    // Returns the pairs whose distance is below the reach at one of several instants of a move.
    std::set<Key> near_pairs(const std::vector<Vec3>& x, const std::vector<Vec3>& move) const
    {
        std::set<Key> near;
        for (const PairCandidate& c : all)
            for (double part : {0.0, 0.2, 0.4, 0.6, 0.8, 1.0}) {
                PairCorners at;
                for (int i = 0; i < 4; ++i) {
                    const int v = c.corner[i];
                    at[i] = v >= 0 ? Vec3(x[v] + part * move[v]) : surface.body_corners[-1 - v];
                }
                if (pair_distance(at, c.edges) < reach) {
                    near.insert(key_of(c));
                    break;
                }
            }
        return near;
    }
};

std::vector<Vec3> sum(std::vector<Vec3> a, const std::vector<Vec3>& b)
{
    for (std::size_t v = 0; v < a.size(); ++v) a[v] += b[v];
    return a;
}

// Checks that the tree's candidates for a move hold all pairs that come near, and that the tree knows which of them it
// had before. Returns the number of the near pairs.
int check_complete(const Sheets& scene, ClothTree& tree, const std::vector<Vec3>& x, const std::vector<Vec3>& move)
{
    const std::vector<real> from = as_planes(x, scene.stride), way = as_planes(move, scene.stride);
    const std::vector<PairCandidate> before = tree.candidates();
    if (tree.cover(from.data(), way.data(), scene.stride, {scene.surface.body_corners}, reach, reach))
        for (std::size_t k = 0; k < tree.kept_from().size(); ++k)
            CHECK(key_of(tree.candidates()[k]) == key_of(before[tree.kept_from()[k]]));
    std::set<Key> found;
    for (const PairCandidate& c : tree.candidates()) {
        CHECK(scene.apart(c));
        CHECK(found.insert(key_of(c)).second);  // each pair is a candidate only once
    }
    const std::set<Key> near = scene.near_pairs(x, move);
    std::vector<Key> missing;
    std::set_difference(near.begin(), near.end(), found.begin(), found.end(), std::back_inserter(missing));
    CHECK(missing.empty());
    return int(near.size());
}

// Crumples the cloth, makes a large move and then small ones, as a solver does. The small moves reuse candidates.
void check_crumpled(const Sheets& scene, double crumple, unsigned seed)
{
    INFO("seed " << seed << ", crumpled by " << crumple);
    std::mt19937 random(seed);
    const double size = spacing * (side - 1);
    ClothTree tree(scene.surface, 0.15 * spacing);
    std::vector<Vec3> x = sum(scene.cloth.positions, random_waves(scene.cloth, crumple * size, size, random));
    int near = check_complete(scene, tree, x, random_waves(scene.cloth, 0, size, random));
    for (double way : {0.2 * size, 0.02 * spacing, 0.02 * spacing, 0.02 * spacing}) {
        const std::vector<Vec3> move = random_waves(scene.cloth, way, size, random);
        near += check_complete(scene, tree, x, move);
        x = sum(x, move);
    }
    CHECK(near > 0);
    CHECK(tree.counts().reused > 0);
    CHECK(tree.counts().whole.searches > 1);
}

std::vector<Body> one_box()
{
    Body body;
    body.mesh = box_mesh(Vec3(0.05, 0.05, -0.06), Vec3(0.05, 0.04, 0.058));
    return {body};
}

Cloth two_sheets(const Cloth& lower)
{
    Cloth cloth = lower;
    add_panel(cloth, grid_cloth(side, side, spacing), Vec3(0.004, 0.007, 0.01));
    return cloth;
}

}  // namespace

TEST_CASE("no pair of a crumpled sheet that comes near on a move is missed", "[tree]")
{
    const Sheets scene(grid_cloth(side, side, spacing));
    for (unsigned seed : {1u, 2u, 3u})
        for (double crumple : {0.35, 0.6}) check_crumpled(scene, crumple, seed);
}

TEST_CASE("no pair is missed on a panel that is not convex", "[tree]")
{
    const Sheets scene(slit_cloth(side, spacing));
    for (unsigned seed : {4u, 5u}) check_crumpled(scene, 0.35, seed);
    // The two sides of the slit can touch although every face stays flat.
    ClothTree tree(scene.surface, 0.15 * spacing);
    std::vector<Vec3> move(scene.cloth.positions.size(), Vec3::Zero());
    for (std::size_t v = 0; v < move.size(); ++v) {
        const Vec3& x = scene.cloth.positions[v];
        if (x.x() > (side / 2 + 0.5) * spacing) move[v].x() = -0.95 * spacing * (1 - x.y() / (spacing * (side - 1)));
    }
    CHECK(check_complete(scene, tree, scene.cloth.positions, move) > 0);
}

TEST_CASE("no pair of two panels, or of a panel and a body, is missed", "[tree]")
{
    const Sheets panels(two_sheets(slit_cloth(side, spacing)));
    check_crumpled(panels, 0.2, 6);
    const Sheets with_body(grid_cloth(side, side, spacing), one_box());
    for (unsigned seed : {7u, 8u}) check_crumpled(with_body, 0.3, seed);
}

TEST_CASE("vertices that are sewn together are not candidates, and no other pair is missed", "[tree]")
{
    Cloth cloth = two_sheets(grid_cloth(side, side, spacing));
    for (int c = 0; c < side; ++c) cloth.seam_pairs.push_back({c, side * side + c});
    const Sheets scene(cloth);
    check_crumpled(scene, 0.2, 9);
}

TEST_CASE("a sheet that is flat or gently curved has no candidates and is skipped as a whole", "[tree]")
{
    const Cloth cloth = grid_cloth(33, 33, spacing);
    const int stride = padded_stride(int(cloth.positions.size()));
    for (double curvature : {0.0, 0.3, 1.0}) {  // [1/m]; the side of the sheet is 0.64 m
        ClothTree tree(tree_surface(make_topology(cloth, false), cloth), 0.15 * spacing);
        std::vector<Vec3> x = cloth.positions;
        if (curvature > 0)
            for (Vec3& p : x)
                p = {std::sin(curvature * p.x()) / curvature, p.y(), std::cos(curvature * p.x()) / curvature};
        const std::vector<real> pos = as_planes(x, stride);
        tree.cover(pos.data(), nullptr, stride, {{}}, 0.002, 0.002);
        CHECK(tree.candidates().empty());
        CHECK(tree.counts().flat_skipped == 1);
    }
}

TEST_CASE("a sheet that was flat and is folded has candidates again, and none when it is flat once more", "[tree]")
{
    const Cloth cloth = grid_cloth(33, 33, spacing);
    const int stride = padded_stride(int(cloth.positions.size()));
    ClothTree tree(tree_surface(make_topology(cloth, false), cloth), 0.15 * spacing);
    std::vector<Vec3> folded = cloth.positions;
    for (Vec3& p : folded)
        if (p.x() > 0.3) p = {0.6 - p.x(), p.y(), 0.001};
    for (const bool flat : {true, false, true, false}) {
        const std::vector<real> pos = as_planes(flat ? cloth.positions : folded, stride);
        tree.cover(pos.data(), nullptr, stride, {{}}, 0.002, 0.002);
        CHECK(tree.candidates().empty() == flat);
    }
}

TEST_CASE("a translation of the whole cloth needs no new search", "[tree]")
{
    std::mt19937 random(10);
    const Sheets scene(grid_cloth(side, side, spacing));
    ClothTree tree(scene.surface, 0.15 * spacing);
    std::vector<Vec3> x = sum(scene.cloth.positions, random_waves(scene.cloth, 0.06, 0.16, random));
    const std::vector<Vec3> move(x.size(), Vec3(3, -2, 1));
    for (int k = 0; k < 4; ++k) {
        CHECK(check_complete(scene, tree, x, move) > 0);
        x = sum(x, move);
    }
    CHECK(tree.counts().whole.searches == 1);
    CHECK(tree.counts().reused == 3);
}

namespace {

// A move of some of the cloth: random waves within a distance of a random vertex, and very small ones elsewhere.
std::vector<Vec3> local_move(const Sheets& scene, double size, double radius, std::mt19937& random)
{
    std::vector<Vec3> move = random_waves(scene.cloth, size, spacing * side, random);
    const std::vector<Vec3> elsewhere = random_waves(scene.cloth, 0.01 * spacing, spacing * side, random);
    const Vec2 middle = scene.cloth.panel_coordinates[random() % move.size()];
    for (std::size_t v = 0; v < move.size(); ++v)
        if ((scene.cloth.panel_coordinates[v] - middle).norm() > radius) move[v] = elsewhere[v];
    return move;
}

}  // namespace

TEST_CASE("where a part of the cloth leaves its searched move only that is searched again, and no pair is missed",
          "[tree]")
{
    const Cloth two = two_sheets(slit_cloth(side, spacing));
    for (const Sheets& scene :
         {Sheets(grid_cloth(side, side, spacing)), Sheets(two), Sheets(grid_cloth(side, side, spacing), one_box())}) {
        for (unsigned seed : {11u, 12u, 13u}) {
            INFO("seed " << seed);
            std::mt19937 random(seed);
            ClothTree tree(scene.surface, 0.15 * spacing);
            std::vector<Vec3> x = sum(scene.cloth.positions, random_waves(scene.cloth, 0.05, 0.16, random));
            int near = 0;
            for (int k = 0; k < 12; ++k) {
                const std::vector<Vec3> move = local_move(scene, (k % 3 + 0.2) * spacing, 2.5 * spacing, random);
                near += check_complete(scene, tree, x, move);
                if (k % 2) x = sum(x, move);
            }
            CHECK(near > 0);
            CHECK(tree.counts().partial.searches >= 6);
        }
    }
}

TEST_CASE("a part that was flat and bends has its pairs searched though the rest is as before", "[tree]")
{
    Cloth cloth = grid_cloth(33, 33, spacing);
    add_panel(cloth, grid_cloth(20, 20, spacing), Vec3(0, 0, 0.5));
    const int stride = padded_stride(int(cloth.positions.size()));
    TreeSurface surface = tree_surface(make_topology(cloth, false), cloth);
    add_bodies(surface, one_box());  // with a body the frame stays where it is
    const std::vector<Vec3> corners = surface.body_corners;
    ClothTree tree(surface, 0.15 * spacing);
    std::vector<Vec3> folded = cloth.positions;
    for (Vec3& p : folded)
        if (p.x() > 0.4 && p.z() == 0) p = {0.8 - p.x(), p.y(), 0.001};
    for (const bool flat : {true, false, true, false}) {
        const std::vector<real> pos = as_planes(flat ? cloth.positions : folded, stride);
        tree.cover(pos.data(), nullptr, stride, {corners}, 0.002, 0.002);
        const auto& found = tree.candidates();
        const bool near_itself = std::any_of(found.begin(), found.end(), [](const PairCandidate& pair) {
            return std::min(pair.corner[0], pair.corner[3]) >= 0;
        });
        CHECK((flat || near_itself));
    }
    CHECK(tree.counts().whole.searches == 1);
    CHECK(tree.counts().partial.searches > 0);
}

TEST_CASE("a part of the cloth that sleeps keeps its pairs while what is awake is searched again", "[tree]")
{
    const Sheets scene(grid_cloth(side, side, spacing), one_box());
    std::mt19937 random(14);
    ClothTree tree(scene.surface, 0.15 * spacing);
    std::vector<Vec3> x = sum(scene.cloth.positions, random_waves(scene.cloth, 0.05, 0.16, random));
    int near = check_complete(scene, tree, x, std::vector<Vec3>(x.size(), Vec3::Zero()));
    std::vector<char> is_awake(x.size());
    for (std::size_t v = 0; v < x.size(); ++v) is_awake[v] = scene.cloth.panel_coordinates[v].x() < 0.04;
    tree.let_sleep(&is_awake);
    for (int k = 0; k < 12; ++k) {
        std::vector<Vec3> move = local_move(scene, (k % 3 + 0.2) * spacing, 2.5 * spacing, random);
        for (std::size_t v = 0; v < x.size(); ++v)
            if (!is_awake[v]) move[v].setZero();
        near += check_complete(scene, tree, x, move);
        if (k % 2) x = sum(x, move);
    }
    CHECK(near > 0);
    CHECK(tree.counts().partial.searches > 0);
}
