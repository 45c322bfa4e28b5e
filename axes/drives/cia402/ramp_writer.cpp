#include "axes/drives/cia402/ramp_writer.hpp"

#include <algorithm>
#include <span>

namespace taktwerk::axes::cia402 {

void RampWriter::step(ecat::Master& bus, std::size_t slave) {
    if (ticket_ != 0) {
        const auto answer = bus.poll(ticket_);
        if (!answer) return;
        ticket_ = 0;
        if (answer->ok()) objects_[next_].known = value_;
        else next_ = ramps;  // refused: this request is never done
        ++next_;
    }
    if (forget_.exchange(false, std::memory_order_acq_rel))
        for (auto& object : objects_) object.known.reset();
    const auto wanted = request_.load(std::memory_order_acquire);
    if (wanted != working_) {
        working_ = wanted;
        next_ = 0;
    }
    for (; working_ != 0 && next_ < ramps; ++next_) {
        auto& object = objects_[next_];
        value_ = values_[next_].load(std::memory_order_relaxed);
        if (object.index == 0 || value_ == 0 || object.known == value_) continue;
        std::array<std::byte, 4> data{};
        for (std::size_t i = 0; i < data.size(); ++i) data[i] = static_cast<std::byte>(value_ >> (8 * i) & 0xFFu);
        ticket_ = bus.download(slave, object.index, 0, std::span{data}.first(std::min(object.bytes, data.size())));
        return;
    }
    if (working_ != 0 && next_ == ramps) done_.store(working_, std::memory_order_release);
}

}  // namespace taktwerk::axes::cia402
