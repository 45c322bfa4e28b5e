#pragma once
// Keeps one Modbus TCP device exchanged, beside the cycle: reads, writes, reconnects. What waits in it waits on the thread that calls
// step(); the cycle looks into a mailbox.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/latest_value.hpp"
#include "modbus/tcp/exchange.hpp"
#include "modbus/tcp/request_plan.hpp"

namespace taktwerk::modbus::tcp {

class DevicePoller {
public:
    /// First and longest pause between two attempts to connect; it doubles with each one that failed.
    static constexpr Duration shortest_pause = std::chrono::milliseconds{100}, longest_pause = std::chrono::seconds{5};

    /// `outputs`: the words that written channels have at first, one for each channel. `exchange` outlives the poller.
    DevicePoller(DeviceConfig device, Exchange& exchange, std::vector<std::int64_t> outputs);

    // --- its own thread --------------------------------------------------------------------------------------------------------
    /// At most one request or one connection, so it takes the device's `timeout` at most.
    void step(Instant now);
    /// Before the end, until it says false: one write of outputs that changed, where the device is connected. The first that fails is the
    /// last one; then the connection ends.
    [[nodiscard]] bool finish(Instant now);

    // --- the cycle; real-time safe --------------------------------------------------------------------------------------------
    struct RequestState {
        Instant done{};     ///< when the last one that succeeded was sent
        bool ever = false;  ///< one has succeeded
        Fault fault{};      ///< of the last one; none while all is well
        friend bool operator==(const RequestState&, const RequestState&) = default;
    };
    struct Report {
        std::vector<std::int64_t> words;     ///< of each channel; of those that are read what came last
        std::vector<RequestState> requests;  ///< as requests()
    };
    /// On the thread of step() and in its place, where nobody is asked: the device says this.
    void replay(const Report& report) {
        reports_.back() = report;
        reports_.publish();
    }
    /// The newest one, and whether it is another one than last time.
    [[nodiscard]] LatestValue<Report>::Reading report() noexcept { return reports_.read(); }
    /// What the written channels shall be: a word for each channel of the device.
    void put(std::span<const std::int64_t> words) noexcept;

    // --- any thread: fixed ------------------------------------------------------------------------------------------------------
    [[nodiscard]] const DeviceConfig& device() const noexcept { return device_; }
    [[nodiscard]] const std::vector<Request>& requests() const noexcept { return requests_; }

private:
    struct Progress {
        RequestState state;
        std::vector<std::uint16_t> written;  // what the device has confirmed
        Instant due{};                       // writes: although nothing changed
    };
    void connect(Instant now);
    /// What the written channels of a request are now.
    void encode(const Request& request);
    [[nodiscard]] bool to_write(std::size_t request, Instant now);
    [[nodiscard]] Fault write(std::size_t request, Instant now);
    [[nodiscard]] Fault read(std::size_t request);
    void note(std::size_t request, Instant now, Fault fault);
    [[nodiscard]] bool answers_once(Fault fault) const noexcept;
    void publish();

    DeviceConfig device_;
    Exchange& exchange_;
    std::vector<Request> requests_;
    std::vector<Progress> progress_;
    std::vector<std::uint16_t> values_;  // of the request at work
    std::vector<std::int64_t> words_;
    LatestValue<Report> reports_;
    LatestValue<std::vector<std::int64_t>> outputs_;
    std::size_t answered_ = 0;  ///< requests that succeeded in this connection
    bool wrote_last_ = false;
    std::size_t next_write_ = 0, first_read_ = 0, next_read_ = 0;  // next_read_ == requests_.size(): all were read in this poll
    Instant next_poll_{}, next_attempt_{};
    Duration pause_ = shortest_pause;
};

}  // namespace taktwerk::modbus::tcp
