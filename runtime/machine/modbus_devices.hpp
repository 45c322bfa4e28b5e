#pragma once
// Modbus TCP devices in the cycle: what they said last becomes inputs with an age, outputs go to their mailboxes, and what is lost has an
// alarm with its cause.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "modbus/tcp/device_poller.hpp"
#include "runtime/machine/machine_body.hpp"

namespace taktwerk::runtime {

class ModbusDevices {
public:
    /// `exchanges`: one per device of the configuration, in its order; they outlive this. A device without one is an error.
    ModbusDevices(MachineBody& body, const std::vector<modbus::tcp::Exchange*>& exchanges, std::vector<Error>& errors);

    // --- beside the cycle: each device on a thread of its own ----------------------------------------------------------------------
    [[nodiscard]] std::size_t count() const noexcept { return devices_.size(); }
    /// One request at most; it takes the device's `timeout` at most.
    void step(std::size_t device, Instant now) { devices_[device]->poller.step(now); }
    /// One write of outputs that changed, at the end; false: nothing is left.
    [[nodiscard]] bool finish(std::size_t device, Instant now) { return devices_[device]->poller.finish(now); }

    /// For a replay, in the place of step(): what the requests came to and the words that were read; all of a cycle at once. False: there is no
    /// such device, request or channel.
    [[nodiscard]] bool replay(std::uint16_t device, std::uint16_t request, const modbus::tcp::DevicePoller::RequestState& state);
    [[nodiscard]] bool replay_word(std::uint16_t device, std::uint16_t channel, std::int64_t word);
    void publish_replayed();

    // --- cycle: real-time safe -------------------------------------------------------------------------------------------------------
    /// Before the inputs are read.
    void read() noexcept;
    /// After the outputs are known. Until the machine is armed the devices get the safe values.
    void write() noexcept;
    /// Alarms of devices with something too old.
    void watch() noexcept;

    // --- any thread -----------------------------------------------------------------------------------------------------------------
    [[nodiscard]] static bool is_alarm(AlarmId id) noexcept;
    /// Source of an alarm, and what it says beyond its table: "Modbus device 'valves'".
    [[nodiscard]] std::string source(const AlarmFact& fact) const;
    /// ", at 192.168.1.50:502, unit 1; ..."
    [[nodiscard]] std::string detail(const AlarmFact& fact) const;
    /// Of an exception code; empty: none that the protocol knows.
    [[nodiscard]] static std::string_view words_of_exception(double code);

private:
    using Poller = modbus::tcp::DevicePoller;
    struct InputPlace {
        std::size_t point, channel, request;
    };
    struct OutputPlace {
        std::size_t point, channel;
    };
    struct Device {
        Device(const modbus::tcp::DeviceConfig& config, modbus::tcp::Exchange& exchange, std::vector<std::int64_t> first)
            : poller(config, exchange, first),
              words(std::move(first)),
              recorded(poller.requests().size()),
              replayed{std::vector<std::int64_t>(words.size()), recorded} {}
        Poller poller;
        const Poller::Report* report = nullptr;
        std::vector<InputPlace> inputs;
        std::vector<OutputPlace> outputs;
        std::vector<std::int64_t> words;  // for the outputs
        std::vector<Poller::RequestState> recorded;
        std::optional<Instant> since;  // watched
        Poller::Report replayed;
        bool replay_is_new = false;
    };
    [[nodiscard]] bool too_old(const Device& device, std::size_t request) const noexcept;
    void record(std::uint16_t index, Device& device) noexcept;

    MachineBody& body_;
    std::vector<std::unique_ptr<Device>> devices_;
};

}  // namespace taktwerk::runtime
