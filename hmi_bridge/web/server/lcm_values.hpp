#pragma once
// A machine's whole states over LCM while somebody looks: opened beside the loop, read in it, closed again. Included by web_server.cpp alone.

#include <unistd.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "hmi_bridge/lcm/channels.hpp"
#include "hmi_bridge/lcm/lcm_opening.hpp"
#include "hmi_bridge/lcm/whole_states.hpp"
#include "hmi_bridge/web/lcm_offer.hpp"
#include "hmi_bridge/web/server/beast.hpp"

namespace taktwerk::hmi::web {

class LcmValues : public std::enable_shared_from_this<LcmValues> {
public:
    LcmValues(asio::io_context& io, LcmOffer offer, const std::string& machine)
        : readable_(io), offer_(std::move(offer)), channel_(Channels(machine).whole_state()), states_(offer_.run) {}

    /// `watched`: somebody looks.
    void step(Instant at, bool watched) {
        if (watched) wanted_ = at;
        if (!offer_.why_not.empty()) return;
        if (bus_ && at - wanted_ > kept_unwatched) return close();
        if (opening_) look_at_opening(at);
        else if (!bus_ && watched && at >= open_again_) open(at);
        if (bus_) look_at_newest(at);
    }
    void close() {
        error_code ignored;
        readable_.close(ignored);
        opening_.reset();
        bus_.reset();
        newest_.reset();
        states_.look_away();
    }
    /// Whole states come.
    [[nodiscard]] bool delivers(Instant at) const { return bus_ && came_ != Instant{} && at - came_ <= patience; }
    /// None has come yet, and it is too early to say that none will.
    [[nodiscard]] bool may_come(Instant at) const {
        return (opening_ || bus_) && !failed_ && !delivers(at) && at - std::max(began_, came_) <= patience;
    }
    /// The newest, once.
    [[nodiscard]] std::optional<taktwerk_lcm::whole_state_v5_t> take() { return std::exchange(newest_, std::nullopt); }
    [[nodiscard]] Instant came() const { return came_; }
    [[nodiscard]] std::uint64_t lost() const { return states_.lost(); }
    [[nodiscard]] std::uint64_t refused() const { return states_.refused(); }
    [[nodiscard]] const std::string& why_not() const { return offer_.why_not.empty() ? why_not_ : offer_.why_not; }

private:
    static constexpr Duration patience = 300ms;        ///< below the 500 ms after which a page shows its values as old
    static constexpr Duration kept_unwatched = 10s;    ///< a page that is loaded again finds it open
    static constexpr Duration open_again_after = 10s;  ///< somebody may have given the group its route meanwhile
    static constexpr Duration judged_each = 1s;        ///< pages are told of another reason no more often
    static constexpr int most_at_once = 32;            ///< messages, then others have their turn

    void open(Instant at) {
        began_ = at;
        opening_.emplace(offer_.url, channel_, [weak = weak_from_this()](std::span<const std::byte> message) {
            if (const auto self = weak.lock()) self->states_.receive(message, now());
        });
    }
    void look_at_opening(Instant at) {
        auto opened = opening_->take();
        if (!opened) {
            if (!failed_) why_not_ = "LCM is still being opened";
            return;
        }
        opening_.reset();
        open_again_ = at + open_again_after;
        began_ = at;
        if (!*opened) {
            why_not_ = opened->error().what + ". " + opened->error().remedy;
            failed_ = true;
            return;
        }
        bus_ = std::move(**opened);
        error_code failure;
        readable_.assign(::dup(bus_->descriptor()), failure);
        if (!failure) return wait();
        why_not_ = "LCM cannot be waited for: " + failure.message();
        bus_.reset();
    }
    void wait() {
        readable_.async_wait(asio::posix::stream_descriptor::wait_read, [self = shared_from_this()](error_code failure) {
            if (failure || !self->bus_) return;
            self->bus_->poll(most_at_once);
            self->wait();
        });
    }
    void look_at_newest(Instant at) {
        if (auto state = states_.take()) {
            newest_ = std::move(state);
            came_ = states_.came();
            failed_ = false;
        }
        if (delivers(at) || may_come(at) || at - judged_ < judged_each) return;
        judged_ = at;
        if (states_.foreign() != foreign_seen_)
            why_not_ = "another machine of this name, or another run of it, publishes at " + offer_.url.text;
        else if (states_.refused() != refused_seen_) why_not_ = "what comes on " + channel_ + " is no whole state of this version";
        else
            why_not_ =
                "no whole state comes on " + channel_ + " at " + offer_.url.text +
                ". See that machine and page server are in one network namespace; as root: `ip link set lo multicast on` and `ip route add "
                "224.0.0.0/4 dev lo`";
        foreign_seen_ = states_.foreign();
        refused_seen_ = states_.refused();
    }

    asio::posix::stream_descriptor readable_;
    LcmOffer offer_;
    std::string channel_, why_not_ = "LCM has not been opened yet";
    WholeStates states_;
    std::optional<LcmOpening> opening_;
    std::unique_ptr<LcmBus> bus_;
    std::optional<taktwerk_lcm::whole_state_v5_t> newest_;
    bool failed_ = false;  ///< LCM could not be opened when it was tried last
    Instant began_{}, came_{}, wanted_{}, open_again_{}, judged_{};
    std::uint64_t foreign_seen_ = 0, refused_seen_ = 0;
};

}  // namespace taktwerk::hmi::web
