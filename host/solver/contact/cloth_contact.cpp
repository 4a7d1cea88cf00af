#include "host/solver/contact/cloth_contact.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "host/model/body.hpp"
#include "host/parallel/launch.hpp"
#include "host/solver/contact/fabric_contact.hpp"

namespace selvage {
namespace {

constexpr double keep = 0.1;           // part of a pair's distance that a move leaves, or of the gap if that is less
constexpr double held_keep = 0.5;      // the same for moves of bodies and held vertices: cloth makes way in between
constexpr double apart = 5e-3;         // of the gap: what pairs never come to, as their barrier has it
constexpr double scarce = 1e-6;        // part of the gap: pairs as near as that come nearer by small parts only
constexpr double held_scarce = 1e-4;   // the same for moves of bodies and held vertices
constexpr double nearly_all = 0.9;     // such a small part leaves this much
constexpr double slack_of_edge = 0.1;  // slack of the tree's boxes, of an edge length
constexpr float jammed = 0.05f;        // part of the way of pins: with less they go on without what follows them
constexpr float most_ahead = 0.25f;    // the part that they then go, so that the cloth can make way
constexpr double body_part = 0.25;     // of the gap: where edges and corners of bodies press; before, vertices do
constexpr int rounds = 4;              // of holding vertices back before the whole move is scaled

std::vector<Body> touchable(const std::vector<Body>& bodies, const Cloth& cloth)
{
    std::vector<Body> result;
    for (const Body& body : bodies)
        if (!clear_by_vertices(body, cloth)) result.push_back(body);
    return result;
}

TreeSurface whole_surface(const Topology& topology, const Cloth& cloth, const std::vector<Body>& bodies)
{
    TreeSurface surface = tree_surface(topology, cloth);
    add_bodies(surface, bodies);
    return surface;
}

}  // namespace

ClothContact::ClothContact(const Topology& topology, const Cloth& cloth, const std::vector<Body>& bodies, double gap,
                           std::vector<double> friction)
    : gap_(gap), body_gap_(body_part * gap), friction_(std::move(friction)),
      area_(std::size_t(topology.particle_count)), faces_(topology.faces), bodies_(touchable(bodies, cloth)),
      keep_(keep), nearest_(scarce * gap),
      tree_(whole_surface(topology, cloth, bodies_), slack_of_edge * typical_edge(cloth)), tangled_(area_.size()),
      inside_(area_.size()), pierced_(area_.size())
{
    for (std::size_t f = 0; f < cloth.faces.size(); ++f) {
        const Face& c = cloth.faces[f];
        const Vec2 a = cloth.panel_coordinates[c[1]] - cloth.panel_coordinates[c[0]];
        const Vec2 b = cloth.panel_coordinates[c[2]] - cloth.panel_coordinates[c[0]];
        for (int particle : topology.faces[f]) area_[particle] += std::abs(a.x() * b.y() - a.y() * b.x()) / 6;
    }
    for (const Body& body : bodies_)
        body_now_.insert(body_now_.end(), body.mesh.vertices.begin(), body.mesh.vertices.end());
    body_goal_ = body_now_;
    // What moving bodies push goes along with them: it has to be known from where vertices are pressed on.
    body_reach_ = any_moves(bodies_) ? gap_ : body_gap_;
}

Vec3 ClothContact::place(int corner, const Way& way) const
{
    if (corner < 0) return body_now_[-1 - corner];
    return {way.pos[corner], way.pos[way.stride + corner], way.pos[2 * way.stride + corner]};
}

Vec3 ClothContact::move(int corner, const Way& way) const
{
    if (corner < 0) return way.body_move ? (*way.body_move)[-1 - corner] : Vec3(Vec3::Zero());
    const std::vector<real>& u = *way.move;
    return {u[corner], u[way.stride + corner], u[2 * way.stride + corner]};
}

PairCorners ClothContact::places(const PairCandidate& candidate, const Way& way) const
{
    const auto& c = candidate.corner;
    return {place(c[0], way), place(c[1], way), place(c[2], way), place(c[3], way)};
}

PairCorners ClothContact::moves(const PairCandidate& candidate, const Way& way) const
{
    const auto& c = candidate.corner;
    return {move(c[0], way), move(c[1], way), move(c[2], way), move(c[3], way)};
}

double ClothContact::gap_of(const PairCandidate& candidate) const
{
    if (std::min(candidate.corner[0], candidate.corner[3]) >= 0) return gap_;
    // A vertex on a body is pressed by the body's plane already.
    return candidate.edges || candidate.corner[0] < 0 ? body_gap_ : 0;
}

// How near a pair may come in one move. No barrier lets it come to a two-hundredth of its gap, and many moves one after
// the other must not lead to where rounding decides either.
double ClothContact::least_distance(const PairCandidate& candidate, const Look& look) const
{
    const bool body = std::min(candidate.corner[0], candidate.corner[3]) < 0;
    const double distance = std::min<double>(look.distance, gap_), never = apart * (body ? body_gap_ : gap_);
    const double room = distance - never;
    if (room <= 0) return nearly_all * distance;
    return never + (room > 2 * nearest_ ? std::max(keep_ * room, nearest_) : nearly_all * room);
}

// Cloth that is on the wrong side of something has to get out again.
bool ClothContact::may_pass(const PairCandidate& candidate) const
{
    const bool body = std::min(candidate.corner[0], candidate.corner[3]) < 0;
    bool all_tangled = true, any_inside = false;
    for (int v : candidate.corner) {
        if (v < 0) continue;
        all_tangled = all_tangled && tangled_[v];
        any_inside = any_inside || inside_[v];
    }
    return all_tangled || (body && any_inside);
}

void ClothContact::cover(const State& state, const Way& way)
{
    const int vs = state.size.vertex_stride;
    const bool afresh = tree_.cover(state.pos.data(), way.move ? way.move->data() : nullptr, vs,
                                    {body_now_, way.body_move, body_version_}, gap_, body_reach_);
    look_at_all(state, way, afresh);
}

// How far each corner has gone since the last look and is to go now, but for what the whole cloth has in common.
void ClothContact::measure_ways(const Way& way)
{
    const int n = int(area_.size()), m = int(body_now_.size());
    const bool first = seen_.empty();
    for (std::vector<float>* v : {&gone_, &way_}) v->resize(std::size_t(n + m));
    seen_.resize(std::size_t(n + m));
    const auto mean_of = [n](const auto& component) {
        Vec3 mean;
        for (int c = 0; c < 3; ++c) mean[c] = sum_items(n, [&](int v) { return component(v, c); }) / n;
        return mean;
    };
    const Vec3 gone =
        first ? Vec3(Vec3::Zero()) : mean_of([&](int v, int c) { return way.pos[c * way.stride + v] - seen_[v][c]; });
    const Vec3 ahead =
        way.move ? mean_of([&](int v, int c) { return (*way.move)[c * way.stride + v]; }) : Vec3(Vec3::Zero());
    for_each_item(n + m, [&, this](int k) {
        const int corner = k < n ? k : n - 1 - k;
        const Vec3 x = place(corner, way);
        gone_[k] = first ? 0 : rounded_up((x - seen_[k] - gone).norm());
        way_[k] = way.move ? rounded_up((move(corner, way) - ahead).norm()) : 0;
        seen_[k] = x;
    });
}

// Measures those candidates that may be in contact on the way; of the others a bound is enough to know that they are
// not.
void ClothContact::look_at_all(const State&, const Way& way, bool afresh)
{
    const std::vector<PairCandidate>& candidates = tree_.candidates();
    looks_.resize(candidates.size());
    ++counts_.looks;
    if (candidates.empty()) return;
    measure_ways(way);
    for_each_item(int(candidates.size()), [&, this](int k) {
        const PairCandidate& candidate = candidates[k];
        std::array<int, 4> c;
        for (int i = 0; i < 4; ++i) c[i] = slot(candidate.corner[i]);
        const auto both_sides = [&](const std::vector<float>& of) {
            return candidate.edges ? std::max(of[c[0]], of[c[1]]) + std::max(of[c[2]], of[c[3]])
                                   : of[c[0]] + std::max({of[c[1]], of[c[2]], of[c[3]]});
        };
        Look& look = looks_[k];
        look.approach = both_sides(way_);
        look.distance = afresh ? candidate.distance : look.distance - both_sides(gone_);
        look.near = look.distance - look.approach < gap_;
        if (!look.near) return;
        if (!afresh) look.distance = rounded_down(pair_distance(places(candidate, way), candidate.edges));
        if (way.move) look.approach = rounded_up(pair_approach(moves(candidate, way), candidate.edges));
        look.near = look.distance - look.approach < gap_;
    });
}

void ClothContact::update(State& state)
{
    cover(state, {state.pos, nullptr, nullptr, state.size.vertex_stride});
    list_pairs(state);
}

void ClothContact::clear_way(State& state, std::vector<real>& move, bool uniform)
{
    const Way way{state.pos, &move, nullptr, state.size.vertex_stride};
    cover(state, way);
    bool free = false, cut = false;
    for (int round = 0; round < rounds && !uniform && !free; ++round) {
        free = !hold_back(move, way, free_parts(way));
        if (free) break;
        cut = true;
        cover(state, way);  // what moved along with a vertex that is held back now comes nearer to it
    }
    if (!free) {
        const float part = scale_all(way);
        if (part < 1) for_each_item(int(move.size()), [&move, part](int i) { move[i] *= part; });
        cut = cut || part < 1;
    }
    counts_.shortened += cut;
    list_pairs(state);
}

bool ClothContact::is_clear_from(State& state, const std::vector<real>& from)
{
    std::vector<real> move(from.size());
    for_each_item(int(move.size()), [&](int i) { move[i] = state.pos[i] - from[i]; });
    const std::vector<real> end = state.pos;
    state.pos = from;
    const Way way{state.pos, &move, nullptr, state.size.vertex_stride};
    cover(state, way);
    const bool clear = scale_all(way) == 1;
    state.pos = end;
    update(state);
    return clear;
}

// How much of the move a candidate is free for. @param enough  1 is returned where at least this much is free
float ClothContact::free_part(int k, const Way& way, float enough) const
{
    const Look& look = looks_[k];
    if (!look.near) return 1;
    const PairCandidate& candidate = tree_.candidates()[k];
    const double least = least_distance(candidate, look);
    if (look.approach < look.distance - least || may_pass(candidate)) return 1;
    const double free = free_fraction(places(candidate, way), moves(candidate, way), candidate.edges, look.distance,
                                      look.approach, least, enough);
    return free < 1 ? rounded_down(free) : 1;
}

std::vector<float> ClothContact::free_parts(const Way& way) const
{
    std::vector<float> part(tree_.candidates().size(), 1.0f);
    for_each_item(int(part.size()), [&, this](int k) { part[k] = free_part(k, way, 1); });
    return part;
}

// The part of the whole move that nothing stands in the way of. Who is free for as much as others leave is not looked
// at any further.
float ClothContact::scale_all(const Way& way) const
{
    std::atomic<float> least = 1;
    for_each_item(int(tree_.candidates().size()), [&, this](int k) {
        float so_far = least.load(std::memory_order_relaxed);
        const float part = free_part(k, way, so_far);
        while (part < so_far && !least.compare_exchange_weak(so_far, part)) {
        }
    });
    return least;
}

// One round: cuts the moves of those who would hit something. Returns whether there were any.
// @param part  of each candidate, as free_parts gives it
bool ClothContact::hold_back(std::vector<real>& move, const Way& way, const std::vector<float>& part) const
{
    const std::vector<PairCandidate>& candidates = tree_.candidates();
    std::vector<float> of_vertex(area_.size(), 1.0f);
    bool any = false;
    for (std::size_t k = 0; k < candidates.size(); ++k) {
        if (part[k] == 1) continue;
        any = true;
        for (int v : candidates[k].corner)
            if (v >= 0) of_vertex[v] = std::min(of_vertex[v], part[k]);
    }
    for_each_item(int(area_.size()), [&](int v) {
        if (of_vertex[v] == 1) return;
        for (int c = 0; c < 3; ++c) move[c * way.stride + v] *= of_vertex[v];
    });
    return any;
}

void ClothContact::begin(State& state)
{
    state.set_body_points(int(body_now_.size()));
    std::fill(inside_.begin(), inside_.end(), 1);
    find_inside(state);
    find_tangles(state);
    show_bodies(state);
}

// Only cloth that starts inside a body may pass its surface, on its way out.
void ClothContact::find_inside(const State& state)
{
    if (bodies_.empty() || state.contact_offset.empty()) {
        std::fill(inside_.begin(), inside_.end(), 0);
        return;
    }
    const int vs = state.size.vertex_stride;
    counts_.inside = int(sum_items(state.size.vertex_count, [&, this](int v) {
        double along = -state.contact_offset[v];
        for (int c = 0; c < 3; ++c) along += state.contact_normal[c * vs + v] * state.pos[c * vs + v];
        inside_[v] = inside_[v] && along < 0;
        return inside_[v] ? 1.0 : 0.0;
    }));
}

std::vector<real> ClothContact::faults() const
{
    std::vector<real> result(inside_.size());
    for (std::size_t v = 0; v < result.size(); ++v) result[v] = inside_[v] + 2 * tangled_[v] + 4 * pierced_[v];
    return result;
}

void ClothContact::set_faults(const std::vector<real>& faults)
{
    counts_.inside = counts_.tangles = 0;
    for (std::size_t v = 0; v < inside_.size(); ++v) {
        inside_[v] = int(faults[v]) & 1;
        tangled_[v] = int(faults[v]) >> 1 & 1;
        pierced_[v] = int(faults[v]) >> 2 & 1;
        counts_.inside += inside_[v];
        counts_.tangles += tangled_[v];
    }
}

void ClothContact::find_tangles(const State& state)
{
    const int n = state.size.vertex_count, vs = state.size.vertex_stride;
    std::vector<Vec3> x(static_cast<std::size_t>(n));
    for (int v = 0; v < n; ++v) x[v] = {state.pos[v], state.pos[vs + v], state.pos[2 * vs + v]};
    std::fill(tangled_.begin(), tangled_.end(), 0);
    std::fill(pierced_.begin(), pierced_.end(), 0);
    const auto mark = [this](int face) {
        for (int v : faces_[face]) tangled_[v] = 1;
    };
    counts_.tangles = 0;
    for (const auto& [a, b] : self_intersections(x, faces_)) {
        mark(a);
        mark(b);
        ++counts_.tangles;
    }
    if (targets_version_ != body_version_) renew_targets();
    for (const std::unique_ptr<IntersectionTarget>& target : targets_)
        for (const auto& [a, b] : target->intersections(x, faces_)) {
            mark(a);
            for (int v : faces_[a]) pierced_[v] = 1;
            ++counts_.tangles;
        }
}

void ClothContact::renew_targets()
{
    targets_.clear();
    std::size_t first = 0;
    for (const Body& body : bodies_) {
        TriangleMesh mesh = body.mesh;
        std::copy_n(body_now_.begin() + std::ptrdiff_t(first), mesh.vertices.size(), mesh.vertices.begin());
        first += mesh.vertices.size();
        targets_.push_back(std::make_unique<IntersectionTarget>(std::move(mesh)));
    }
    targets_version_ = body_version_;
}

void ClothContact::aim(const std::vector<std::pair<int, Vec3>>& pins, double time)
{
    pins_ = pins;
    goal_time_ = time;
    std::size_t first = 0;
    for (const Body& body : bodies_) {
        if (body.motion) {
            const std::vector<Vec3> vertices = body_mesh_at(body, time).vertices;
            std::copy(vertices.begin(), vertices.end(), body_goal_.begin() + std::ptrdiff_t(first));
        }
        first += body.mesh.vertices.size();
    }
    pending_ = true;
}

void ClothContact::place_bodies(State& state, double time)
{
    aim({}, time);
    pending_ = false;
    time_ = time;
    body_now_ = body_goal_;
    ++body_version_;
    show_bodies(state);
}

std::vector<Vec3> ClothContact::ways_of_bodies() const
{
    std::vector<Vec3> ways(body_now_.size());
    for (std::size_t k = 0; k < ways.size(); ++k) ways[k] = body_goal_[k] - body_now_[k];
    if (std::all_of(ways.begin(), ways.end(), [](const Vec3& u) { return u.isZero(0); })) ways.clear();
    return ways;
}

// Lets vertices go along with the nearest point of a body that comes towards them or holds them.
// @param way  that of the bodies alone; who is near has been looked at
void ClothContact::ride(const State& state, const Way& way, std::vector<real>& move) const
{
    const std::vector<PairCandidate>& candidates = tree_.candidates();
    std::vector<int> nearest(area_.size(), -1);
    for (std::size_t k = 0; k < candidates.size(); ++k) {
        const auto& c = candidates[k].corner;
        if (!looks_[k].near || looks_[k].distance > gap_) continue;
        if (std::max(c[0], c[3]) < 0 || std::min(c[0], c[3]) >= 0) continue;
        for (int v : c)
            if (v >= 0 && (nearest[v] < 0 || looks_[k].distance < looks_[nearest[v]].distance)) nearest[v] = int(k);
    }
    for_each_item(int(area_.size()), [&, this](int v) {
        if (nearest[v] < 0 || state.inv_mass[v] == 0) return;
        const PairCandidate& candidate = candidates[nearest[v]];
        const PairCorners x = places(candidate, way);
        const pair_weights p = closest_weights(x, candidate.edges);
        Vec3 from_body = Vec3::Zero(), shift = Vec3::Zero();
        double sum = 0;
        for (int i = 0; i < 4; ++i) {
            from_body += p.w[i] * x[i];
            if (candidate.corner[i] >= 0) continue;
            sum += p.w[i];
            shift += p.w[i] * (*way.body_move)[-1 - candidate.corner[i]];
        }
        shift /= sum;
        if (candidate.corner[0] < 0) from_body = -from_body;
        const bool held = !state.friction_limit.empty() && state.friction_limit[v] > 0;
        if (!held && shift.dot(from_body) <= 0) return;
        for (int c = 0; c < 3; ++c) move[c * way.stride + v] = shift[c];
    });
}

// Cloth that only goes along need not come as far as the pins that lead it: who would hit something stays behind, so
// that a jam in one place does not stop pins in another. What these themselves would hit is left to the caller.
void ClothContact::let_followers_wait(const State& state, const Way& way, std::vector<real>& move)
{
    const auto leads = [&](int corner) { return corner >= 0 && state.inv_mass[corner] == 0; };
    for (int round = 0; round < rounds; ++round) {
        std::vector<float> part = free_parts(way);
        const std::vector<PairCandidate>& candidates = tree_.candidates();
        for_each_item(int(part.size()), [&](int k) {
            const auto& c = candidates[k].corner;
            if (part[k] < 1 && std::any_of(c.begin(), c.end(), leads)) part[k] = 1;
        });
        if (!hold_back(move, way, part)) return;
        cover(state, way);
    }
}

bool ClothContact::advance_held(State& state, const Follow& follow)
{
    if (!pending_) return false;
    const int vs = state.size.vertex_stride;
    std::vector<real> move(state.pos.size());
    const std::vector<Vec3> body_move = ways_of_bodies();
    const Way way{state.pos, &move, body_move.empty() ? nullptr : &body_move, vs};
    bool pins_move = false;
    for (const auto& [particle, goal] : pins_)
        for (int c = 0; c < 3; ++c) {
            real& u = move[c * vs + particle];
            u = goal[c] - state.pos[c * vs + particle];
            pins_move = pins_move || u != 0;
        }
    if (pins_move) follow(move);
    if (way.body_move) {
        cover(state, {state.pos, nullptr, nullptr, vs});
        ride(state, way, move);
    }
    cover(state, way);
    keep_ = held_keep;
    nearest_ = held_scarce * gap_;
    float part = scale_all(way);
    if (part < jammed && !way.body_move) {  // what a body presses on goes ahead of it, or is run through
        let_followers_wait(state, way, move);
        part = std::min(scale_all(way), most_ahead);
    }
    keep_ = keep;
    nearest_ = scarce * gap_;
    time_ = part == 1 ? goal_time_ : time_ + part * (goal_time_ - time_);
    if (carry_) carry_(state, time_);
    for_each_item(int(move.size()), [&](int i) { state.pos[i] += part * move[i]; });
    if (part == 1)
        for (const auto& [particle, goal] : pins_)
            for (int c = 0; c < 3; ++c) state.pos[c * vs + particle] = goal[c];
    for (std::size_t k = 0; k < body_move.size(); ++k)
        body_now_[k] = part == 1 ? body_goal_[k] : Vec3(body_now_[k] + part * body_move[k]);
    pending_ = part < 1;
    body_version_ += !body_move.empty();
    show_bodies(state);
    update(state);
    return pending_;
}

void ClothContact::show_bodies(State& state) const
{
    if (state.body_point.empty()) return;
    for (std::size_t k = 0; k < body_now_.size(); ++k)
        for (int c = 0; c < 3; ++c)
            state.body_point[c * std::size_t(state.size.body_point_stride) + k] = body_now_[k][c];
}

std::size_t ClothContact::bytes() const
{
    return tree_.bytes() + looks_.capacity() * sizeof(Look) + listed_.capacity() * sizeof(int) + area_.size() * 8 +
           (memory_.capacity() + 6 * body_now_.size() + 3 * seen_.size()) * sizeof(real);
}

}  // namespace selvage
