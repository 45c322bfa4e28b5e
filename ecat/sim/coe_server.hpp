#pragma once
// The mailbox of a simulated slave, the CoE servers behind it and the services beside them (files, Ethernet). Messages are queued (at most max_pending), answered one
// after the other, each after the response delay of machine time. A full queue leaves the mailbox full: the master's next
// write gets working counter 0. Emergencies of the application go out as soon as the mailbox is free, before an answer that
// waits. A repeat request brings back the message that was read last, then the one it displaced. In BOOT nothing but files is served.
// Fixed buffers. Source: ETG.1000.4 (mailbox), ETG.1000.6 (CoE), SV33-E manual 6.2.8.

#include <cstdint>
#include <span>
#include <vector>

#include "core/time.hpp"
#include "ecat/description/device_description.hpp"
#include "ecat/sim/device_model.hpp"
#include "ecat/sim/emergency_queue.hpp"
#include "ecat/sim/mailbox_service.hpp"
#include "ecat/sim/object_dictionary.hpp"
#include "ecat/sim/request_queue.hpp"
#include "ecat/sim/sdo_info_server.hpp"
#include "ecat/sim/sdo_server.hpp"
#include "ecat/sim/slave_controller.hpp"
#include "ecat/wire/mailbox.hpp"

namespace taktwerk::ecat::sim {

class CoeServer final : public EmergencyPort {
public:
    CoeServer(const DeviceDescription& description, ObjectDictionary& dictionary, DeviceModel& model, SlaveController& controller,
              Duration response_delay);

    /// Mailbox sync managers of the description: out (master writes), in.
    [[nodiscard]] unsigned out_sm() const noexcept { return boxes_.out_sm; }
    [[nodiscard]] unsigned in_sm() const noexcept { return boxes_.in_sm; }

    /// Who answers this protocol; it outlives the server. Before the first start().
    void attach(MailboxType type, MailboxService& service) noexcept { services_.attach(type, service); }

    /// PREOP or BOOT was entered from INIT: nothing pending, counters forgotten.
    void start(EsmState state) noexcept;
    void stop() noexcept;
    /// Takes waiting messages into the queue and answers what is due; serves repeat requests.
    void step(EsmState state, Instant now) noexcept;
    [[nodiscard]] Instant next_event() const noexcept;

    /// From the application. Dropped before PREOP, and when emergency_limit of them wait already.
    void send(const Emergency& emergency) noexcept override;
    static constexpr std::size_t emergency_limit = EmergencyQueue::limit;

    /// Test: the mailbox answers nothing and takes nothing until it is released.
    void stick(bool stuck) noexcept { stuck_ = stuck; }
    /// Test: the next answers claim a length that is not theirs: in turn one byte more than the mailbox has,
    /// one byte short, none.
    void misstate_lengths(std::uint32_t answers) noexcept { wrong_lengths_ = answers; }
    void abort_object(std::uint16_t index, std::uint8_t sub, std::uint32_t code) { sdo_.abort_object(index, sub, code); }
    void never_toggle() noexcept { sdo_.never_toggle(); }
    void set_response_delay(Duration delay) noexcept { response_delay_ = delay; }
    [[nodiscard]] std::size_t pending() const noexcept { return queue_.size(); }

private:
    void take(Instant now) noexcept;
    void answer(EsmState state, Instant now) noexcept;
    /// What the message at the head of the queue gets as answer: its type and payload size; 0: nothing.
    std::size_t serve(std::span<const std::byte> bytes, std::span<std::byte> out, MailboxType& type, EsmState state, Instant now) noexcept;
    /// Notices what the master has read, serves a repeat request.
    void follow_mailbox() noexcept;
    void deliver() noexcept;
    bool put(std::span<const std::byte> message) noexcept;
    /// More goes out before the next message is answered.
    [[nodiscard]] bool more_pending() const noexcept { return info_.pending() || services_.pending(); }
    void fetch_more() noexcept;

    const DeviceDescription& description_;
    SlaveController& controller_;
    SdoServer sdo_;
    SdoInfoServer info_;
    MailboxServices services_;
    struct Boxes {
        unsigned out_sm = 0, in_sm = 1;
        std::size_t in_size = 0;  ///< to the master, in this state
    } boxes_;
    Duration response_delay_;
    RequestQueue queue_;              // of max_pending messages
    std::vector<std::byte> reply_;    // an answer that is built and waits for the mailbox to be free
    std::vector<std::byte> unasked_;  // an emergency
    std::vector<std::byte> current_;  // what is in the mailbox, or was displaced from it by a repetition
    std::vector<std::byte> read_;     // what the master read last, for a repeat request
    enum class InBox : std::uint8_t { nothing, current, repetition } in_box_ = InBox::nothing;
    bool reply_waiting_ = false, displaced_ = false, read_valid_ = false;
    EmergencyQueue emergencies_;
    std::uint8_t last_counter_ = 0, counter_ = 0;
    std::uint32_t wrong_lengths_ = 0;
    Instant due_ = never;  // of the first message
    bool running_ = false, stuck_ = false;
};

}  // namespace taktwerk::ecat::sim
