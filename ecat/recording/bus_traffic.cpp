#include "ecat/recording/bus_traffic.hpp"

#include <algorithm>

#include "ecat/wire/frame_fields.hpp"

namespace taktwerk::ecat {

namespace {

constexpr Duration pause = std::chrono::microseconds{50};

MacAddress source_of(std::span<const std::byte> frame) noexcept {
    MacAddress source{};
    for (std::size_t i = 0; i < source.size(); ++i) source[i] = std::to_integer<std::uint8_t>(frame[frame_field::source + i]);
    return source;
}

MacAddress marked(MacAddress address) noexcept {
    address[0] |= frame_field::passed_a_slave;
    return address;
}

/// Kinds are few and told apart by all that does not change from cycle to cycle.
DatagramTraffic* kind_of(MasterTraffic& master, const Datagram& datagram) {
    const auto address = counts_slaves(datagram.command) ? Address::physical(0, datagram.address.ado()) : datagram.address;
    for (auto& known : master.datagrams)
        if (known.command == datagram.command && known.address == address && known.size == datagram.data.size()) return &known;
    if (master.datagrams.size() == BusTraffic::most_kinds) return nullptr;
    return &master.datagrams.emplace_back(DatagramTraffic{datagram.command, address, datagram.data.size(), 0, {}});
}

}  // namespace

void CycleTraffic::note(Instant at) noexcept {
    if (!begun_) first = last = at;
    if (begun_ && at - newest_ >= pause) {
        const auto apart = at - last;
        shortest = cycles == 0 ? apart : std::min(shortest, apart);
        longest = std::max(longest, apart);
        last = at;
        ++cycles;
    }
    begun_ = true;
    newest_ = at;
}

MasterTraffic* BusTraffic::sender_of(std::span<const std::byte> frame) {
    if (frame.size() < ethernet_header_size) return nullptr;
    const auto source = source_of(frame);
    for (auto& known : masters_)
        if (marked(known.address) == marked(source)) return &known;
    if (masters_.size() == most_masters) return nullptr;
    masters_.emplace_back().address = source;
    return &masters_.back();
}

void BusTraffic::note(std::span<const std::byte> frame, Instant at, bool outgoing) {
    ++frames_;
    auto* master = sender_of(frame);
    if (master == nullptr) {
        ++others_;
        return;
    }
    const bool sent = outgoing || (source_of(frame)[0] & frame_field::passed_a_slave) == 0;
    if (sent) {
        master->address = source_of(frame);  // as it is before a slave marks it
        ++master->sent;
        master->sending.note(at);
    } else {
        ++master->back;
        master->returning.note(at);
    }
    FrameReader reader{frame};
    while (const auto datagram = reader.next()) {
        auto* kind = kind_of(*master, *datagram);
        if (kind == nullptr) ++master->other_datagrams;
        else if (sent) ++kind->sent;
        else ++kind->working_counters[datagram->working_counter()];
    }
    if (reader.error() != FrameError::none) ++master->damaged;
}

}  // namespace taktwerk::ecat
