#include "axes/axis/master_side.hpp"

#include "axes/axis/command_kinds.hpp"
#include "axes/axis/coupling_links.hpp"

namespace taktwerk::axes {

MasterTrack::Reading MasterSide::reading(MC_Source source) const noexcept {
    MasterTrack::Reading reading;
    reading.feed = body_.units.feed();
    reading.largest_velocity = body_.config.limits.velocity;
    if (source == mcActualValue) {
        reading.motion = {{body_.units.anchor(), measured_.local()}, measured_.feedback.velocity / body_.units.counts_per_unit(), 0};
        reading.usable = measured_.online();
        reading.fresh = measured_.feedback.fresh;
        reading.planned = false;
        reading.taken = measured_.feedback.latched;
        return reading;
    }
    const auto& set = motion_.setpoint.state();
    reading.motion = {{body_.units.anchor(), set.position}, set.velocity, set.acceleration};
    reading.usable = measured_.seeded;
    // A drive without power moves as it likes, and its set-point with it: a measured position.
    reading.planned = !body_.power.follows_actual() && !runs_.drive.busy();
    reading.taken = body_.now;
    return reading;
}

MasterList MasterSide::running_masters() const noexcept {
    MasterList list;
    for (const auto axis : links_.state.running.masters.axes)
        if (axis.valid()) list.axes[list.count++] = axis;
    return list;
}

MasterList MasterSide::masters() const noexcept {
    MasterList list;
    const auto add = [&](const MasterChoice& choice) noexcept {
        for (const auto axis : choice.axes)
            if (axis.valid()) list.axes[list.count++] = axis;
    };
    if (links_.state.running.id != 0) add(links_.state.running.masters);
    if (links_.state.next.id != 0) add(links_.state.next.masters);
    if (couples(body_.queue.active().command.kind)) add(masters_of(body_.queue.active().command));
    for (std::size_t i = 0; i < body_.queue.waiting(); ++i)
        if (couples(body_.queue.waiting_at(i).command.kind)) add(masters_of(body_.queue.waiting_at(i).command));
    return list;
}

bool MasterSide::is_followed_by(const MasterSide& master) const noexcept {
    const std::uint64_t walk = (static_cast<std::uint64_t>(++walks_) << 16) | body_.index;
    const MasterSide* at = &master;
    at->walk_ = walk;
    at->walk_back_ = nullptr;
    while (at) {
        if (at == this) return true;
        auto list = at->masters();
        if (at->links_.path_master.valid()) list.axes[list.count++] = at->links_.path_master;
        const MasterSide* further = nullptr;
        for (std::size_t i = 0; i < list.count && !further; ++i) {
            const MasterSide* next = links_.axis(list.axes[i]);
            if (next && next->walk_ != walk) further = next;
        }
        if (further) {
            further->walk_ = walk;
            further->walk_back_ = at;
            at = further;
        } else at = at->walk_back_;
    }
    return false;
}

}  // namespace taktwerk::axes
