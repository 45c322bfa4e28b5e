#include "ecat/sim/sim_network.hpp"

#include <algorithm>
#include <utility>

namespace taktwerk::ecat::sim {

SimSlave& SimNetwork::add(std::shared_ptr<const DeviceDescription> description, std::unique_ptr<DeviceModel> model, SlaveOptions options) {
    slaves_.push_back({std::make_unique<SimSlave>(std::move(description), std::move(model), std::move(options)), true});
    slaves_.back().slave->power_on(now_);
    show_links();
    schedule();
    return *slaves_.back().slave;
}

void SimNetwork::set_power(std::size_t position, bool on) {
    SimSlave& s = slave(position);
    if (on == s.powered()) return;
    if (on) s.power_on(now_);
    else s.power_off(now_);
    show_links();
    schedule();
}

void SimNetwork::set_cable(std::size_t position, bool plugged) {
    slaves_[position].cable = plugged;
    show_links();
}

void SimNetwork::show_links() noexcept {
    for (std::size_t i = 0; i < slaves_.size(); ++i) {
        if (!slaves_[i].slave->powered()) continue;
        const bool before = slaves_[i].cable && (i == 0 || slaves_[i - 1].slave->powered());
        const bool after = i + 1 < slaves_.size() && slaves_[i + 1].cable && slaves_[i + 1].slave->powered();
        slaves_[i].slave->controller().set_links(before, after);
    }
}

std::size_t SimNetwork::reachable() const noexcept {
    std::size_t count = 0;
    while (count < slaves_.size() && slaves_[count].cable && slaves_[count].slave->powered()) {
        ++count;
        if (slaves_[count - 1].slave->controller().port1_forced_closed()) break;
    }
    return count;
}

void SimNetwork::fire_until(Instant now) noexcept {
    schedule();  // a test may have touched a slave directly
    while (next_event_ <= now) {
        // The earliest event anywhere; of two at the same instant the slave nearer to the master first.
        auto* first = slaves_.front().slave.get();
        for (auto& place : slaves_)
            if (place.slave->next_event() < first->next_event()) first = place.slave.get();
        first->fire(first->next_event());
        schedule();
    }
    now_ = std::max(now_, now);
}

void SimNetwork::schedule() noexcept {
    next_event_ = never;
    for (const auto& place : slaves_) next_event_ = std::min(next_event_, place.slave->next_event());
}

void SimNetwork::advance(Instant now) noexcept {
    if (now < now_) return;
    fire_until(now);
    for (auto& place : slaves_) place.slave->settle(now);
}

std::optional<Duration> SimNetwork::process(std::span<std::byte> frame, Instant now) noexcept {
    fire_until(now);
    if (lose_ > 0) {
        --lose_;
        return std::nullopt;
    }
    const std::size_t count = reachable();
    if (count == 0) return std::nullopt;

    std::size_t n = 0;
    if (frame.size() <= max_frame_size) {
        FrameEditor editor{frame};
        while (n < datagrams_.size()) {
            const auto datagram = editor.next();
            if (!datagram) break;
            datagrams_[n++] = *datagram;
        }
        // A frame with a defect passes unchanged: the controllers execute only what is sound as a whole.
        if (editor.error() != FrameError::none) n = 0;
    }

    const std::span<MutableDatagram> datagrams{datagrams_.data(), n};
    Instant at = now;
    for (std::size_t i = 0; i < count; ++i) {
        at += timing_.cable;
        slaves_[i].slave->process(datagrams, at);
        at += timing_.forward;
    }
    // The way back: the last slave turned the frame around; before it, each sees it again at port 1.
    slaves_[count - 1].slave->frame_returned(std::nullopt);
    for (std::size_t i = count - 1; i-- > 0;) {
        at += timing_.cable;
        slaves_[i].slave->frame_returned(at);
        at += timing_.back;
    }
    at += timing_.cable;
    // The processing unit marks what it forwarded: locally administered source address.
    if (n > 0) frame[6] |= std::byte{0x02};
    schedule();
    return at - now;
}

}  // namespace taktwerk::ecat::sim
