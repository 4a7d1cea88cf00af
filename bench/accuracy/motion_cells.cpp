#include "bench/accuracy/motion_cells.hpp"

#include <cmath>
#include <fstream>
#include <limits>
#include <stdexcept>

#include <fmt/format.h>

#include "bench/harness/child_run.hpp"
#include "host/solver/stepping/integrator.hpp"

namespace selvage {
namespace {

struct MotionTuning {
    // Of the side of a sheet [1]. The first is what the picture of a motion shows; the second was chosen by hand.
    static constexpr double accurate = 0.05, garbage = 0.1;
    static constexpr double reference_step = 1e-4;  // [s]; explicit schemes shorten it to their stability limit
};

std::string scene_text(const MotionModel& model)
{
    return fmt::format(
        "[[sheet]]\nwidth={0}\nheight={0}\nresolution=9\ncenter=[{1},0,1]\nfabric=\"f\"\n"
        "[pins]\nsheet=\"left_edge\"\n[contact]\nself=false\n[output]\npicture=false\n"
        "[solver]\nuntil={2:.6f}\nframe_rate=0.01\n"
        "[fabric.f]\nareal_density=0.3\nthickness=0.0003\nstretch_weft={3}\nstretch_warp={3}\nshear={4}\n"
        "bending_weft={5}\nbending_warp={5}\nfriction=0\ndamping=0\n",
        model.side(), 0.5 * model.side(), model.until(), model.stretch, 0.4 * model.stretch, model.bending);
}

bool is_explicit(const std::string& name)
{
    for (const IntegratorInfo& info : integrators())
        if (info.name == name) return info.is_explicit;
    return false;
}

// @param refuse  the scheme is explicit, and is not to shorten steps above its stability limit
ChildRun run_sheet(const MotionModel& model, const std::string& integrator, double step, bool refuse)
{
    const WorkFolder folder;
    const std::string scene = folder.file("sheet.toml");
    std::ofstream(scene) << scene_text(model);
    std::vector<std::string> arguments = {scene, "--threads", "1"};
    for (const std::string& value : {"integrator=" + integrator, fmt::format("step={:.9g}", step),
                                     std::string(refuse ? "unstable_step=refuse" : "")})
        if (!value.empty()) arguments.insert(arguments.end(), {"--set", "solver." + value});
    return run_child(own_program(), arguments);
}

double error_of(const std::vector<Vec3>& positions, const std::vector<Vec3>& reference, double side)
{
    if (positions.size() != reference.size()) return std::numeric_limits<double>::infinity();
    double sum = 0;
    for (std::size_t v = 0; v < reference.size(); ++v) sum += (positions[v] - reference[v]).squaredNorm();
    return std::sqrt(sum / double(reference.size())) / side;
}

std::vector<Vec3> reference_of(const MotionModel& model, const std::string& integrator)
{
    ChildRun run = run_sheet(model, integrator, MotionTuning::reference_step, false);
    if (!run.finished()) throw std::runtime_error("no reference by " + integrator + ": " + run.errors);
    return std::move(run.positions);
}

MotionVerdict verdict_of(const ChildRun& run, double error)
{
    const bool warned = !run.summary.is_null() && !run.summary["warnings"].empty();
    if (!run.finished() || (warned && error > MotionTuning::accurate)) return MotionVerdict::said;
    if (error <= MotionTuning::accurate) return MotionVerdict::accurate;
    return error <= MotionTuning::garbage ? MotionVerdict::rough : MotionVerdict::silent;
}

}  // namespace

double MotionModel::until() const
{
    // A rigid sheet is a pendulum of 2/3 of its side, which takes K(1/sqrt 2) sqrt(l/g) from level to hanging.
    constexpr double gravity = 9.81;
    return std::comp_ellint_1(std::sqrt(0.5)) * std::sqrt(side() / 1.5 / gravity);
}

const char* name_of(MotionVerdict verdict)
{
    constexpr const char* names[motion_verdicts] = {"accurate", "rough", "said", "silent"};
    return names[int(verdict)];
}

std::vector<MotionModel> motion_models(bool quick)
{
    std::vector<MotionModel> models;
    for (double edge : quick ? std::vector<double>{0.05} : std::vector<double>{0.002, 0.01, 0.05})
        for (double stretch : {1.0, 1e2, 1e4, 1e7})
            for (double bending : {1e-7, 1e-2}) models.push_back({stretch, bending, edge});
    return models;
}

std::vector<MotionCell> motion_cells(const MotionModel& model)
{
    std::vector<MotionCell> cells;
    for (const IntegratorInfo& info : integrators())
        for (double step : {1e-4, 1e-3, 1e-2, 3.3e-2})
            if (info.order > 0) cells.push_back({model, std::string(info.name), step});
    return cells;
}

MotionReference motion_reference(const MotionModel& model)
{
    MotionReference reference{reference_of(model, "rk4"), reference_of(model, "velocity_verlet")};
    reference.difference = error_of(reference.other, reference.positions, model.side());
    return reference;
}

MotionResult run_motion(const MotionCell& cell, const MotionReference& reference)
{
    const ChildRun run = run_sheet(cell.model, cell.integrator, cell.step, is_explicit(cell.integrator));
    MotionResult result;
    result.cell = cell;
    const bool own = cell.integrator == "rk4";
    result.error = error_of(run.positions, own ? reference.other : reference.positions, cell.model.side());
    result.verdict = verdict_of(run, result.error);
    result.exit_code = run.exit_code;
    result.seconds = run.cpu_s;
    result.message = run.errors;
    result.estimate = std::numeric_limits<double>::quiet_NaN();
    if (!run.summary.is_null())
        if (const auto& estimate = run.summary["accuracy"]["largest_time_error_m"]; estimate.is_number())
            result.estimate = estimate.get<double>() / cell.model.side();
    return result;
}

}  // namespace selvage
