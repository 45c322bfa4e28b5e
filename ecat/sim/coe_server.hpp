#pragma once
// The mailbox of a simulated slave and the SDO server behind it. Messages are queued (at most max_pending), answered one
// after the other, each after the response delay of machine time. A full queue leaves the mailbox full: the master's next
// write gets working counter 0. Fixed buffers. Source: ETG.1000.4 (mailbox), ETG.1000.6 (SDO), SV33-E manual 6.2.8.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/time.hpp"
#include "ecat/device_description.hpp"
#include "ecat/sim/device_model.hpp"
#include "ecat/sim/object_dictionary.hpp"
#include "ecat/sim/sdo_server.hpp"
#include "ecat/sim/slave_controller.hpp"

namespace taktwerk::ecat::sim {

class CoeServer {
public:
    CoeServer(const DeviceDescription& description, ObjectDictionary& dictionary, DeviceModel& model, SlaveController& controller,
              Duration response_delay);

    /// Mailbox sync managers of the description: out (master writes), in.
    [[nodiscard]] unsigned out_sm() const noexcept { return out_sm_; }
    [[nodiscard]] unsigned in_sm() const noexcept { return in_sm_; }

    /// PREOP was entered from below: nothing pending, counters forgotten.
    void start() noexcept;
    void stop() noexcept;
    /// Takes waiting messages into the queue and answers what is due; serves repeat requests.
    void step(EsmState state, Instant now) noexcept;
    [[nodiscard]] Instant next_event() const noexcept;

    /// Test: the mailbox answers nothing and takes nothing until it is released.
    void stick(bool stuck) noexcept { stuck_ = stuck; }
    void set_response_delay(Duration delay) noexcept { response_delay_ = delay; }
    [[nodiscard]] std::size_t pending() const noexcept { return count_; }

private:
    struct Slot {
        std::vector<std::byte> bytes;
        std::size_t size = 0;
    };

    void take(Instant now) noexcept;
    void answer(EsmState state, Instant now) noexcept;
    void deliver() noexcept;

    const DeviceDescription& description_;
    SlaveController& controller_;
    SdoServer sdo_;
    unsigned out_sm_ = 0, in_sm_ = 1;
    Duration response_delay_;
    std::vector<Slot> queue_;  // ring of max_pending messages
    std::size_t head_ = 0, count_ = 0;
    std::vector<std::byte> reply_;       // built, waiting for the mailbox to be free
    std::vector<std::byte> last_reply_;  // for a repeat request
    bool reply_waiting_ = false, last_reply_valid_ = false;
    std::uint8_t last_counter_ = 0, counter_ = 0;
    Instant due_ = never;  // of the message at head_
    bool running_ = false, stuck_ = false;
};

}  // namespace taktwerk::ecat::sim
