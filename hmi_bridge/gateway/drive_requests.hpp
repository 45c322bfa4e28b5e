#pragma once
// Parameters of drives while the machine runs, by their manual's names: asked for over the local socket, carried out by the axis'
// DrivePort beside the cycle. Nothing here reaches the cycle. One thread (the service side), not real-time.
//
// Rules. Reading is everybody's. Writing is commissioning: not in automatic mode, and not while a program owns the axis [wrong_mode,
// no_control with the owner's name]; not while an axis of the drive moves by another hand than the asker's, and not while another client that is
// still there has taken, powered or moved one that has power: limits, ramps and gains are part of what it commands [no_control]; a parameter that its manual lets be written only while the motor is off waits for that
// [not_possible_now]. Nothing goes into an EEPROM unless the request says `store`, and the log tells what does. What a write would
// *do* instead of set (restore, clear the encoder's turns) is refused: the machine would not know of it. To clear the turns there is a
// request of its own, by which it does.

#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "axes/port/drive_profile.hpp"
#include "core/result.hpp"
#include "core/time.hpp"
#include "hmi_bridge/gateway/hands.hpp"
#include "hmi_bridge/machine_link.hpp"

namespace taktwerk::hmi {

enum class DriveRequestKind : std::uint8_t {
    read,         ///< one parameter
    write,        ///< one parameter
    store,        ///< all parameters of the drive into its EEPROM
    clear_turns,  ///< the encoder forgets its turns; the axis has no reference afterwards
};

/// As a client sends it. `tag` and `id` come back with the answer; who they are is the caller's idea.
struct DriveRequest {
    DriveRequestKind kind = DriveRequestKind::read;
    std::string axis;
    std::string parameter;  ///< "P05.13", "6084h", "2005h:0E"
    std::string value;      ///< in the parameter's unit: "300 ms"
    bool store = false;     ///< writes: meant for the EEPROM
    std::string who;        ///< for the log: "process 812 of user 0"
    std::uint64_t tag = 0;
    std::string id;
    std::uint32_t client = 0;  ///< of the gateway: whose hand is on an axis
};

struct DriveAnswer {
    std::uint64_t tag = 0;
    std::string id;
    std::optional<Error> error;
    std::string parameter, shown;  ///< read: its name, its value as people read it
    std::vector<std::byte> bytes;  ///< read: little-endian
};

class DriveRequests {
public:
    static constexpr std::size_t at_work = 16;  ///< requests under way at once; more are refused
    static constexpr Duration patience = std::chrono::seconds{2};
    static constexpr Duration store_patience = std::chrono::seconds{10};  ///< an XP200 is silent for 5 s (9.6.6)

    /// `log`: one line for what a person should find later; may be empty. `hands`: of the clients; nullptr: there are none.
    DriveRequests(MachineLink& machine, std::function<void(std::string_view)> log, const Hands* hands = nullptr);

    /// Each gets exactly one answer, sooner or later. `snapshot`: of this step, nullptr before the first cycle.
    void handle(DriveRequest request, const runtime::Snapshot* snapshot, Instant now);
    /// The answers to this tag are wanted no more.
    void forget(std::uint64_t tag) noexcept;
    void step(Instant now);
    std::optional<DriveAnswer> next_answer();

private:
    struct Job {
        DriveAnswer answer;
        axes::DrivePort* port = nullptr;
        const axes::DriveParameter* parameter = nullptr;  ///< of a read
        axes::ServiceTicket ticket = 0;
        Instant until{};
        bool wanted = true;
    };
    struct Place {
        std::uint16_t axis = 0;
        MachineLink::Drive drive;
        const runtime::Snapshot* snapshot = nullptr;
    };
    [[nodiscard]] Result<Place> find(const DriveRequest& request, const runtime::Snapshot* snapshot);
    [[nodiscard]] std::optional<Error> start(const DriveRequest& request, const runtime::Snapshot* snapshot, Job& job);
    [[nodiscard]] std::optional<Error> start_read(const DriveRequest& request, const Place& place, Job& job);
    [[nodiscard]] std::optional<Error> start_write(const DriveRequest& request, const Place& place, Job& job);
    [[nodiscard]] std::optional<Error> start_store(const DriveRequest& request, const Place& place, Job& job);
    [[nodiscard]] std::optional<Error> start_clear_turns(const DriveRequest& request, const Place& place, Job& job);
    /// Who may change something at this drive now.
    [[nodiscard]] std::optional<Error> check_authority(const DriveRequest& request, const Place& place) const;
    /// Somebody else's hand is on an axis of the same drive.
    [[nodiscard]] std::optional<Error> check_hands(const DriveRequest& request, const Place& place) const;
    [[nodiscard]] bool any_axis_powered(const Place& place) const;

    MachineLink& machine_;
    std::function<void(std::string_view)> log_;
    const Hands* hands_;
    std::vector<Job> jobs_;
    std::deque<DriveAnswer> answers_;
};

}  // namespace taktwerk::hmi
