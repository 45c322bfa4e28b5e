#include "ecat/ring/ring_transport.hpp"

#include <algorithm>

#include "core/bytes.hpp"
#include "ecat/wire/registers.hpp"

namespace taktwerk::ecat {

namespace {

constexpr std::size_t index_at = ethernet_header_size + ecat_header_size + 1;
constexpr std::uint8_t twin = 0x80;  // in the last byte of the source address

constexpr std::size_t most_at_once = 128;  ///< frames a call: bounds the cycle when the wire is flooded
constexpr unsigned believed_silent = 8;    ///< frames in a row
constexpr std::int64_t lost_within = 8;    ///< patiences, two cycles: a side that is missing for longer is gone, not its frame lost
constexpr unsigned believed_one_way = 50;  ///< the same, of the second interface: no hurry, and a twin may be late

void copy(std::span<const std::byte> from, std::span<std::byte> to) noexcept { std::copy(from.begin(), from.end(), to.begin()); }

bool comes_from(std::span<const std::byte> frame, const MacAddress& source) noexcept {
    if (frame.size() <= index_at) return false;
    for (std::size_t i = 0; i < source.size(); ++i) {
        const unsigned any = i == 0 ? frame_field::passed_a_slave : 0u;
        if ((static_cast<unsigned>(frame[frame_field::source + i]) | any) != (source[i] | any)) return false;
    }
    return true;
}

}  // namespace

/// What is looked through in each cycle lies close together; the frames themselves elsewhere.
struct RingTransport::Flight {
    using Buffer = std::array<std::byte, max_frame_size>;
    struct Copy {
        Buffer sent, came;
    };
    struct Fate {
        bool left = false;       ///< its interface took it
        bool back = false;       ///< it has arrived ...
        bool touched = false;    ///< (some slave may have changed it)
        std::size_t at = first;  ///< ... at this interface
        Instant arrival{};
    };
    std::size_t size = 0;           ///< 0: free
    std::size_t clock = 0;          ///< offset of the datagram with the reference time; 0: none
    std::byte index{};              ///< of the first datagram
    std::uint16_t second_half = 0;  ///< position of the first slave there, as it was believed
    Instant sent_at{};
    std::array<Fate, copies> fate{};
    std::unique_ptr<std::array<Copy, copies>> copy = std::make_unique<std::array<Copy, copies>>();

    [[nodiscard]] FrameCopy half(std::size_t n) const noexcept {
        const auto sent = std::span<const std::byte>{(*copy)[n].sent}.first(size);
        return {sent, fate[n].back && fate[n].touched ? std::span<const std::byte>{(*copy)[n].came}.first(size) : sent};
    }
    [[nodiscard]] bool went_round(std::size_t n) const noexcept { return fate[n].back && fate[n].at != n; }
    /// It needs no twin: it went round, and somebody was there.
    [[nodiscard]] bool enough(std::size_t n) const noexcept { return went_round(n) && fate[n].touched; }
};

RingTransport::RingTransport(Transport& one, Transport& other, Duration patience)
    : ends_{&one, &other},
      patience_(patience),
      sources_{one.mac(), one.mac()},
      flights_(std::make_unique<std::array<Flight, most_under_way>>()) {
    sources_[second].back() = static_cast<std::uint8_t>(sources_[second].back() ^ twin);
}

RingTransport::~RingTransport() = default;

Instant RingTransport::departure(Instant now) const noexcept { return ends_[first_took_ ? first : second]->departure(now); }

/// A frame that nobody gave back is forgotten when its place is needed: the oldest first.
RingTransport::Flight& RingTransport::free_flight() noexcept {
    Flight* oldest = flights_->data();
    for (auto& flight : *flights_) {
        if (flight.size == 0) return flight;
        if (flight.sent_at < oldest->sent_at) oldest = &flight;
    }
    return *oldest;
}

std::optional<Error> RingTransport::link_trouble() const {
    for (const Transport* end : ends_)
        if (auto trouble = end->link_trouble()) return trouble;
    return std::nullopt;
}

bool RingTransport::send(std::span<const std::byte> frame, Instant now) noexcept {
    if (frame.size() <= index_at || frame.size() > max_frame_size) return false;
    for (auto& flight : *flights_)  // an index that is used again: nobody waits for the frame before
        if (flight.size != 0 && flight.index == frame[index_at]) flight.size = 0;
    Flight& flight = free_flight();
    prepare(flight, frame);
    flight.sent_at = now;
    bool left = false;
    for (std::size_t n = 0; n < copies; ++n) {
        auto& fate = flight.fate[n] = {};
        fate.left = ends_[n]->send(std::span<const std::byte>{(*flight.copy)[n].sent}.first(frame.size()), now);
        left = left || fate.left;
        statistics_.unsent += fate.left ? 0 : 1;
    }
    first_took_ = flight.fate[first].left;
    if (!left) flight.size = 0;
    return left;
}

void RingTransport::prepare(Flight& flight, std::span<const std::byte> frame) noexcept {
    flight.size = frame.size();
    flight.clock = 0;
    flight.index = frame[index_at];
    flight.second_half = state_.second_half();
    auto& [one, other] = *flight.copy;
    copy(frame, one.sent);
    copy(frame, other.sent);
    for (std::size_t i = 0; i < sources_[second].size(); ++i)
        other.sent[frame_field::source + i] = static_cast<std::byte>(sources_[second][i]);
    DatagramWalk walk{frame};
    while (const auto at = walk.next()) {
        if (goes_by_position(static_cast<Command>(frame[*at]))) {
            const auto adp = load_le<std::uint16_t>(frame, *at + frame_field::adp);
            store_le(std::span{other.sent}, *at + frame_field::adp, static_cast<std::uint16_t>(adp + flight.second_half));
        }
        if (static_cast<Command>(frame[*at]) == Command::FRMW &&
            load_le<std::uint16_t>(frame, *at + frame_field::ado) == reg::dc_system_time)
            set_clock(flight, *at);
    }
}

/// Whoever is not addressed takes the time that the datagram brings: so it must bring the reference's, or be a plain read.
void RingTransport::set_clock(Flight& flight, std::size_t at) noexcept {
    flight.clock = at;
    const std::size_t away = home_of_reference_ == first ? second : first;
    auto& sent = (*flight.copy)[away].sent;
    if (away == first || !clocks_.hand_on) {
        sent[at] = static_cast<std::byte>(Command::FPRD);
        return;
    }
    const std::size_t data = at + datagram_header_size;
    store_le(std::span{sent}, data, load_le<std::int64_t>(sent, data) + clocks_.ahead);
}

std::optional<ReceivedFrame> RingTransport::receive(std::span<std::byte> buffer, Instant now) noexcept {
    for (std::size_t taken = 0; asked_ < copies && taken < most_at_once; ++taken) {
        const auto received = ends_[asked_]->receive(buffer, now);
        if (!received) {
            ++asked_;
            continue;
        }
        bool ours = false;
        Flight* complete = take(std::span<const std::byte>{buffer}.first(received->size), asked_, received->at, ours);
        if (!ours) return received;  // whoever matches answers says what it is
        if (complete == nullptr) continue;
        const Instant arrival = std::max(complete->fate[first].arrival, complete->fate[second].arrival);
        const bool missed = missed_its_aim(*complete);
        return ReceivedFrame{give_back(*complete, buffer), arrival, missed};
    }
    if (Flight* single = overdue(now)) {
        const Instant arrival = single->fate[single->fate[first].back ? first : second].arrival;
        const bool half = is_half(*single) || missed_its_aim(*single);
        return ReceivedFrame{give_back(*single, buffer), arrival, half};
    }
    asked_ = first;
    return std::nullopt;
}

RingTransport::Flight* RingTransport::take(std::span<const std::byte> frame, std::size_t end, Instant at, bool& ours) noexcept {
    const bool is_twin = comes_from(frame, sources_[second]);
    if (!is_twin && !comes_from(frame, sources_[first])) return nullptr;
    const std::size_t n = is_twin ? second : first;
    const auto found =
        std::find_if(flights_->begin(), flights_->end(), [&](const Flight& f) { return f.size != 0 && f.index == frame[index_at]; });
    ours = true;
    heard_[n] = std::max(heard_[n], at);
    if (is_twin) twins_missed_ = 0;
    if (found == flights_->end() || found->fate[n].back) {
        ++statistics_.late_copies;
        return nullptr;
    }
    auto& [sent, came] = (*found->copy)[n];
    if (!same_datagrams({std::span<const std::byte>{sent}.first(found->size), frame})) {
        ++statistics_.mangled;
        ours = is_twin;  // one that says that it is the frame sent is rejected by name
        return nullptr;
    }
    // Past every processing unit: nothing in it. Where the address has the mark itself, only a look at all bytes would tell.
    const auto marked = [](std::span<const std::byte> f) {
        return (static_cast<unsigned>(f[frame_field::source]) & frame_field::passed_a_slave) != 0;
    };
    found->fate[n] = {.left = true, .back = true, .touched = marked(sent) || marked(frame), .at = end, .arrival = at};
    if (found->fate[n].touched) copy(frame.first(found->size), came);
    const bool complete = found->enough(first) || (found->fate[first].back && found->fate[second].back);
    return complete ? &*found : nullptr;
}

RingTransport::Flight* RingTransport::overdue(Instant now) noexcept {
    for (auto& flight : *flights_) {
        if (flight.size == 0 || (!flight.fate[first].back && !flight.fate[second].back)) continue;
        const auto& missing = flight.fate[flight.fate[first].back ? second : first];
        if (missing.left && now - flight.sent_at < patience_) continue;
        if (flight.fate[first].back || !flight.went_round(second)) return &flight;
        flight.size = 0;  // nobody has met the twin, and the frame itself got lost
    }
    return nullptr;
}

bool RingTransport::is_half(const Flight& flight) const noexcept {
    const std::size_t missing = flight.fate[first].back ? second : first;
    return !flight.fate[missing].back && flight.fate[missing].left && !flight.went_round(first) &&
           flight.sent_at - heard_[missing] < lost_within * patience_;
}

bool RingTransport::missed_its_aim(const Flight& flight) const noexcept {
    if (!flight.fate[second].back || flight.went_round(second) || flight.went_round(first)) return false;
    const auto half = flight.half(second);
    DatagramWalk walk{half.sent};
    while (const auto at = walk.next()) {
        if (!goes_by_position(static_cast<Command>(half.sent[*at]))) continue;
        RingState then = state_;
        then.before_break = flight.fate[first].back ? slaves_passed(flight.half(first)).value_or(0) : state_.before_break;
        then.behind_break = slaves_passed(half).value_or(0);
        return then.second_half() != flight.second_half;
    }
    return false;
}

std::size_t RingTransport::give_back(Flight& flight, std::span<std::byte> buffer) noexcept {
    const std::size_t size = std::min(flight.size, buffer.size());
    learn(flight);
    // What went round has met everybody: a twin that a slave touched then did so in a half that is no more.
    FrameCopy other = flight.half(second);
    if (flight.went_round(first) && !flight.went_round(second)) other.came = other.sent;
    copy(flight.half(first).sent.first(size), buffer);
    if (flight.clock != 0) buffer[flight.clock] = static_cast<std::byte>(Command::FRMW);
    merge(flight.half(first), other, buffer.first(size));
    flight.size = 0;
    return size;
}

void RingTransport::learn(const Flight& flight) noexcept {
    const auto& [one, other] = flight.fate;
    const RingShape before = state_.shape;
    if (flight.went_round(first)) {
        // Counted here, and set back by each twin that comes, be it too late for its frame.
        if (!other.back) twins_missed_ = std::min(twins_missed_ + 1, believed_one_way);
        if (const auto met = slaves_passed(flight.half(first)))
            exchanged_ = *met == 0 && flight.went_round(second) && slaves_passed(flight.half(second)).value_or(0) > 0;
        state_.shape = exchanged_ ? RingShape::exchanged : twins_missed_ == believed_one_way ? RingShape::one_way : RingShape::closed;
        ++statistics_.round;
    } else {
        state_.shape = !one.back ? RingShape::first_silent : !other.back ? RingShape::second_silent : RingShape::open;
        ++(one.back && other.back ? statistics_.merged : statistics_.single);
    }
    if (before == RingShape::closed && state_.shape != RingShape::closed) ++state_.opened;
    if (const auto passed = slaves_passed(flight.half(first))) {
        // A frame that got lost must not let the second half count from elsewhere: both would answer to one position.
        silent_frames_ = one.back ? 0 : std::min(silent_frames_ + 1, believed_silent);
        if (one.back) state_.before_break = *passed;
        else if (silent_frames_ == believed_silent) state_.before_break = 0;
        if (state_.shape == RingShape::closed || state_.shape == RingShape::one_way) state_.whole = *passed;
        if (flight.went_round(first) && !exchanged_) state_.behind_break = 0;
        else if (other.back) state_.behind_break = slaves_passed(flight.half(second)).value_or(0);
    }
    if (flight.clock == 0) return;
    const auto answered = [&](std::size_t n) {
        const auto [sent, came] = flight.half(n);
        const std::size_t data = flight.clock + datagram_header_size;
        return load_le<std::int64_t>(sent, data) != load_le<std::int64_t>(came, data);
    };
    if (answered(first)) home_of_reference_ = first;
    else if (answered(second)) home_of_reference_ = second;
}

}  // namespace taktwerk::ecat
