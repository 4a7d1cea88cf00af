#pragma once
#include <vector>

#include "host/collision/body_query.hpp"
#include "host/model/body.hpp"
#include "host/model/cloth_model.hpp"
#include "host/solver/contact/contact_field.hpp"
#include "host/solver/contact/contact_hardness.hpp"
#include "host/solver/state/topology.hpp"

namespace selvage {

/// Returns the friction coefficient of every particle: the largest of its panels' fabrics [1].
std::vector<double> particle_friction(const Topology& topology, const Cloth& cloth, const FabricTable& fabrics);

/// How far the middle of a triangle of the cloth may lie below its corners over a round body: L^2 / (6 R) for edges
/// up to L, since no point of a triangle is further than L / sqrt(3) from its nearest corner [m]. 0 for planes and
/// meshes.
double chord_sag(const Body& body, const Cloth& cloth);

/// Whether cloth whose vertices are outside a body by its sag is outside it as a whole: true for planes, and for
/// spheres and capsules that stand still and are not too small for the cloth's triangles.
bool clear_by_vertices(const Body& body, const Cloth& cloth);

/// Contact of the particles with the scene's bodies: the queries of BodyQuery written into the state's fields.
class ClothBodyContact final : public ContactField {
public:
    /// @param gap      distance at which contact sets in [m]
    /// @param margin   further distance within which a vertex already knows its surface [m]
    /// @param hardness  how stiff contact is where it is not as the term says
    /// @param by_faces  edges and faces are kept off those bodies that cloth is not clear of whose vertices are
    ClothBodyContact(BodyQuery& query, const std::vector<Body>& bodies, const Topology& topology, const Cloth& cloth,
                     const FabricTable& fabrics, double gap, double margin, bool by_faces,
                     ContactHardness hardness = {});

    /// Keeps those particles further off whose triangles a body pierces between them, until it does no more.
    /// @param pierced  per particle, as ClothContact has it; must outlive this object   @param by  [m]
    void lift(const std::vector<char>& pierced, double by);

    void update(State& state) override;
    bool crossed(const State& state, const std::vector<real>& from) override;
    double search_radius() const override { return gap_ + margin_; }
    int contact_count() const override { return contact_count_; }
    void set_contact_count(int count) { contact_count_ = count; }  ///< That of planes from a checkpoint.
    /// Per particle, the body whose surface was nearest within search_radius() at the last update; -1: none.
    const std::vector<int>& body_of_vertex() const { return body_of_vertex_; }

    double time() const { return query_.time(); }              ///< At which the bodies are [s].
    double motion_end() const { return query_.motion_end(); }  ///< See BodyQuery.
    /// In which no surface near the cloth leaves what is known of it [s]. @param cloth  where it may come meanwhile [m]
    double longest_step(double time, double room, const Box& cloth) const;
    /// Puts the bodies where they are at a time and finds their surfaces anew.
    void place(State& state, double time);
    /// Moves the bodies from where they are to a time. The friction anchors of vertices in contact go along with the
    /// surface, so friction acts against motion relative to it, and what sticks is carried.
    void move_to(State& state, double time);

private:
    BodyQuery& query_;
    std::vector<double> body_friction_;    ///< Per body; NaN: the fabric's.
    std::vector<double> body_sag_;         ///< Per body: by how much vertices are kept further away [m].
    std::vector<double> fabric_friction_;  ///< Per particle: the largest of its panels'.
    ContactHardness hardness_;
    std::vector<int> body_of_vertex_;
    const std::vector<char>* pierced_ = nullptr;
    double lift_ = 0;  ///< [m]
    double gap_, margin_;
    int contact_count_ = 0;
};

}  // namespace selvage
