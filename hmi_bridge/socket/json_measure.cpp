#include "hmi_bridge/socket/json_measure.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <nlohmann/json.hpp>

#include "axes/measuring/cogging.hpp"
#include "axes/measuring/feed_forward.hpp"
#include "axes/measuring/frequency_response.hpp"
#include "axes/measuring/friction_curve.hpp"
#include "axes/measuring/step_response.hpp"
#include "hmi_bridge/socket/json_number.hpp"

namespace taktwerk::hmi {

using axes::MeasureKind;
using axes::measuring::AlignedRun;
using axes::measuring::Doubt;
using axes::measuring::Estimate;
using axes::measuring::LegRange;

namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t most_points = 800;  ///< of one curve

std::string dumped(Json json) {
    spell_out_numbers(json);
    return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

Json estimate(const Estimate& e) { return e.known ? Json{{"value", e.value}, {"deviation", e.deviation}} : Json(nullptr); }

Json thinned(const std::vector<double>& values, LegRange range) {
    auto out = Json::array();
    const auto step = std::max<std::size_t>(1, (range.end - range.begin + most_points - 1) / most_points);
    for (std::size_t i = range.begin; i < range.end; i += step) out.push_back(values[i]);
    return out;
}

/// Of one leg over the time since it began.
Json leg_curve(const AlignedRun& run, std::size_t leg) {
    const auto range = axes::measuring::range_of(run, leg);
    std::vector<double> since(run.size()), error(run.size());
    for (std::size_t i = range.begin; i < range.end; ++i) {
        since[i] = run.time[i] - run.time[range.begin];
        error[i] = run.reference[i] - run.actual[i];
    }
    return Json{{"leg", leg},
                {"time_s", thinned(since, range)},
                {"set_position", thinned(run.reference, range)},
                {"actual_position", thinned(run.actual, range)},
                {"following_error", thinned(error, range)},
                {"set_velocity", thinned(run.velocity, range)},
                {"actual_velocity", thinned(run.actual_velocity, range)},
                {"torque", thinned(run.torque, range)}};
}

void put_moves(Json& out, const AlignedRun& aligned, const axes::ExcitationPlan& plan, double window) {
    const auto response = axes::measuring::step_response(aligned, plan, window);
    out["doubt"] = word(response.doubt);
    out["window"] = response.window;
    out["resolution"] = response.resolution;
    out["overshoot"] = estimate(response.overshoot);
    out["settling_time_s"] = estimate(response.settling_time);
    out["all_settled"] = response.all_settled;
    out["rise_time_s"] = estimate(response.rise_time);
    out["largest_error"] = estimate(response.largest_error);
    out["error_at_velocity"] = estimate(response.at_velocity);
    out["velocity_ripple"] = estimate(response.ripple);
    out["lag_s"] = response.at_velocity.known ? Json(response.lag) : Json(nullptr);
    auto& moves = out["moves"] = Json::array();
    for (const auto& move : response.moves)
        moves.push_back(Json{{"leg", move.leg},
                             {"distance", move.distance},
                             {"overshoot", move.overshoot},
                             {"settling_time_s", move.settling_time},
                             {"settled", move.settled},
                             {"rise_time_s", move.rise_time},
                             {"largest_error", move.largest_error},
                             {"rms_error", move.rms_error}});
    auto& curves = out["curves"] = Json::array();
    for (std::size_t leg = 0; leg < std::min<std::size_t>(2, response.moves.size()); ++leg) curves.push_back(leg_curve(aligned, leg));
}

/// A key of the machine file with the value that these samples propose.
Json proposal(std::string_view key, const Estimate& value, std::string_view unit) {
    return Json{{"key", key}, {"value", value.value}, {"deviation", value.deviation}, {"unit", unit}};
}

Json load_proposals(const Estimate& gravity, const Estimate& coulomb, const Estimate& viscous) {
    auto out = Json::array();
    if (gravity.known) out.push_back(proposal("control.load.gravity", gravity, ""));
    if (coulomb.known && coulomb.value > 0) out.push_back(proposal("control.load.coulomb_friction", coulomb, ""));
    if (viscous.known && viscous.value > 0) out.push_back(proposal("control.load.viscous_friction", viscous, ""));
    return out;
}

void put_friction(Json& out, const AlignedRun& aligned, const axes::ExcitationPlan& plan, const axes::AxisConfig& config) {
    const auto f = axes::measuring::friction_curve(aligned, plan, config.limits.torque);
    out["doubt"] = word(f.doubt);
    out["gravity"] = estimate(f.gravity);
    out["coulomb"] = estimate(f.coulomb);
    out["viscous"] = estimate(f.viscous);
    out["coulomb_positive"] = estimate(f.coulomb_positive);
    out["coulomb_negative"] = estimate(f.coulomb_negative);
    out["viscous_positive"] = estimate(f.viscous_positive);
    out["viscous_negative"] = estimate(f.viscous_negative);
    out["breakaway_positive"] = estimate(f.breakaway_positive);
    out["breakaway_negative"] = estimate(f.breakaway_negative);
    if (f.doubt == Doubt::none) out["proposals"] = load_proposals(f.gravity, f.coulomb, f.viscous);
    Json velocity = Json::array(), torque = Json::array(), deviation = Json::array(), ripple = Json::array();
    for (const auto& p : f.points) {
        velocity.push_back(p.velocity), torque.push_back(p.torque);
        deviation.push_back(p.deviation), ripple.push_back(p.ripple);
    }
    out["curves"] = Json::array({Json{{"velocity", velocity}, {"torque", torque}, {"deviation", deviation}, {"ripple", ripple}}});
}

void put_following(Json& out, const AlignedRun& aligned, const axes::AxisConfig& config) {
    const auto f = axes::measuring::feed_forward(aligned, config.limits.torque);
    out["doubt"] = word(f.doubt);
    out["lag_s"] = estimate(f.lag);
    out["per_acceleration_s2"] = estimate(f.per_acceleration);
    out["per_direction"] = estimate(f.per_direction);
    out["offset"] = estimate(f.offset);
    out["rms_error"] = f.rms;
    out["rms_left"] = f.rms_left;
    out["explained"] = f.explained;
    const auto& t = f.torque;
    out["torque"] = Json{{"doubt", word(t.doubt)},         {"gravity", estimate(t.gravity)},
                         {"coulomb", estimate(t.coulomb)}, {"viscous", estimate(t.viscous)},
                         {"inertia", estimate(t.inertia)}, {"residual", t.residual},
                         {"explained", t.explained},       {"highest", t.highest}};
    auto proposals = t.doubt == Doubt::none ? load_proposals(t.gravity, t.coulomb, t.viscous) : Json::array();
    if (t.doubt == Doubt::none && t.inertia.known) {
        // 1 / x has the same part of itself as deviation.
        const double rated = 1 / t.inertia.value;
        proposals.push_back(
            proposal("control.rated_acceleration", {rated, rated * t.inertia.deviation / t.inertia.value, true}, config.unit + "/s2"));
    }
    // The position loop that is closed here leaves (1 - feed_forward) v / kv behind; what a drive does by itself is the drive's to set.
    const auto& control = config.control;
    if (f.doubt == Doubt::none && control.mode == axes::ControlMode::velocity && control.kv > 0)
        proposals.push_back(
            proposal("control.feed_forward", {control.feed_forward + f.lag.value * control.kv, f.lag.deviation * control.kv, true}, ""));
    out["proposals"] = std::move(proposals);
    out["control_mode"] = control.mode == axes::ControlMode::velocity ? "velocity" : "position";
    out["feed_forward"] = control.feed_forward;
    auto& curves = out["curves"] = Json::array();
    for (std::size_t leg = 0; leg < 2; ++leg)
        if (const auto range = axes::measuring::range_of(aligned, leg); range.end > range.begin) curves.push_back(leg_curve(aligned, leg));
}

Json margin(const std::optional<axes::measuring::Margin>& m) {
    return m ? Json{{"value", m->value}, {"frequency_hz", m->frequency}} : Json(nullptr);
}

void put_sweep(Json& out, const AlignedRun& aligned, const axes::ExcitationPlan& plan, const axes::AxisConfig& config) {
    using axes::measuring::FrequencyPoint;
    const auto f = axes::measuring::frequency_response(aligned, plan);
    out["doubt"] = word(f.doubt);
    out["phase_margin_deg"] = margin(f.margins.phase);
    out["gain_margin_db"] = margin(f.margins.gain);
    out["bandwidth_hz"] = margin(f.margins.bandwidth);
    out["phase_bandwidth_hz"] = margin(f.margins.phase_bandwidth);
    out["resonance_db"] = margin(f.margins.resonance);
    out["notch_db"] = margin(f.margins.notch);
    out["feed_forward"] = config.control.feed_forward;
    const auto closed_phase = axes::measuring::phases_of(f.points, &FrequencyPoint::closed);
    const auto open_phase = axes::measuring::phases_of(f.points, &FrequencyPoint::open);
    Json curve;
    for (const char* key :
         {"frequency_hz", "amplitude", "limited", "gain_db", "phase_deg", "open_gain_db", "open_phase_deg", "quality", "usable"})
        curve[key] = Json::array();
    for (std::size_t i = 0; i < f.points.size(); ++i) {
        const auto& p = f.points[i];
        const auto decibel = [](std::complex<double> z) { return 20 * std::log10(std::abs(z)); };
        curve["frequency_hz"].push_back(p.frequency);
        curve["amplitude"].push_back(p.amplitude);
        curve["limited"].push_back(p.limited);
        curve["gain_db"].push_back(p.usable ? Json(decibel(p.closed)) : Json(nullptr));
        curve["phase_deg"].push_back(p.usable ? Json(closed_phase[i]) : Json(nullptr));
        curve["open_gain_db"].push_back(p.open_usable ? Json(decibel(p.open)) : Json(nullptr));
        curve["open_phase_deg"].push_back(p.open_usable ? Json(open_phase[i]) : Json(nullptr));
        curve["quality"].push_back(p.quality);
        curve["usable"].push_back(p.usable);
    }
    out["curves"] = Json::array({std::move(curve)});
}

void put_cogging(Json& out, const AlignedRun& aligned, const axes::ExcitationPlan& plan) {
    const auto c = axes::measuring::cogging(aligned, plan);
    out["doubt"] = word(c.doubt);
    out["period"] = c.period;
    out["periods"] = c.periods;
    out["peak_to_peak"] = c.peak_to_peak;
    out["noise"] = c.noise;
    Json waves, curve;
    for (const char* key : {"order", "torque", "error", "velocity"}) waves[key] = Json::array();
    for (const auto& h : c.harmonics) {
        waves["order"].push_back(h.order), waves["torque"].push_back(h.torque);
        waves["error"].push_back(h.error), waves["velocity"].push_back(h.velocity);
    }
    curve["position"] = c.position;
    curve["torque"] = c.torque;
    out["curves"] = Json::array({std::move(waves), std::move(curve)});
}

}  // namespace

axes::MeasureOrder read_measure_order(JsonFields& fields) {
    axes::MeasureOrder order;
    order.kind = axes::measure_kind_of(fields.text("kind", true)).value_or(MeasureKind::none);
    order.count = static_cast<std::uint16_t>(std::clamp<std::int64_t>(fields.integer("count"), 0, 0xFFFF));
    order.distance = fields.number("distance", false);
    order.velocity = fields.number("velocity", false);
    order.acceleration = fields.number("acceleration", false);
    order.from_hz = fields.number("from_hz", false);
    order.to_hz = fields.number("to_hz", false);
    order.period = fields.number("period", false);
    return order;
}

std::string plan_json(const axes::ExcitationPlan& plan, const std::string& unit) {
    const auto& order = plan.order();
    Json out{{"kind", name(order.kind)},   {"unit", unit},
             {"count", order.count},       {"distance", order.distance},
             {"velocity", order.velocity}, {"acceleration", order.acceleration},
             {"jerk", plan.jerk()},        {"start", plan.bounds().start},
             {"lowest", plan.lowest()},    {"highest", plan.highest()},
             {"margin", plan.margin()},    {"duration_s", plan.duration()}};
    if (plan.of_tones()) out["from_hz"] = order.from_hz, out["to_hz"] = order.to_hz;
    if (order.period > 0) out["period"] = order.period;
    return dumped(std::move(out));
}

std::string result_json(const Measurements::Run& run, const axes::AxisConfig& config, double window) {
    const auto& plan = run.samples.plan;
    Json out{{"run", run.state.run},
             {"axis", config.name},
             {"unit", config.unit},
             {"kind", name(plan.order().kind)},
             {"running", run.state.running},
             {"end", name(run.state.end)},
             {"elapsed_s", run.state.elapsed},
             {"plan", Json::parse(plan_json(plan, config.unit))}};
    out["samples"] = run.samples.samples.size();
    if (run.state.running) return dumped(std::move(out));
    const auto unwrapped = [&] {
        auto samples = run.samples;
        axes::measuring::unwrap(samples.samples, config.modulo);
        return axes::measuring::align(samples);
    };
    const auto aligned = config.modulo > 0 ? unwrapped() : axes::measuring::align(run.samples);
    out["lost"] = aligned.lost;
    out["dead_time_s"] = aligned.dead_time;
    const double settled = window > 0 ? window : config.windows.in_position;
    switch (plan.order().kind) {
        case MeasureKind::step:
        case MeasureKind::ramp: put_moves(out, aligned, plan, settled); break;
        case MeasureKind::friction: put_friction(out, aligned, plan, config); break;
        case MeasureKind::sweep: put_sweep(out, aligned, plan, config); break;
        case MeasureKind::following: put_following(out, aligned, config); break;
        case MeasureKind::cogging: put_cogging(out, aligned, plan); break;
        case MeasureKind::none: break;
    }
    return dumped(std::move(out));
}

}  // namespace taktwerk::hmi
