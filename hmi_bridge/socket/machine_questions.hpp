#pragma once
// Questions about a machine beyond its state: how its cycle spends its time, its bus as a tree, what the manuals say of its drives, its log. Lines
// in, answers out, one for each. Nothing here reaches the cycle; looking at the bus takes a few datagrams that the cycle has to spare, once a second
// at most however many ask. One thread (the service side), not real-time.

#include <array>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.hpp"
#include "core/time.hpp"
#include "ecat/diagnosis/running_survey.hpp"
#include "hmi_bridge/line_handler.hpp"
#include "hmi_bridge/machine_link.hpp"
#include "hmi_bridge/socket/json_fields.hpp"
#include "hmi_bridge/socket/log_tail.hpp"

namespace taktwerk::hmi {

class MachineQuestions {
public:
    static constexpr std::array<std::string_view, 4> words{"histograms", "bus", "drive_parameters", "log"};
    static constexpr Duration look_period = std::chrono::seconds{1};  ///< ports of the bus are looked at so often at most
    static constexpr std::size_t most_log_lines = 500;                ///< of one answer

    struct Answer {
        ConnectionId connection = 0;
        std::string id;
        Result<std::string> body;  ///< "\"bus\":{...}": what stands behind "ok"
    };

    explicit MachineQuestions(MachineLink& machine) : machine_(machine) {}
    ~MachineQuestions();
    MachineQuestions(const MachineQuestions&) = delete;
    MachineQuestions& operator=(const MachineQuestions&) = delete;

    void set_log(std::shared_ptr<const LogTail> log) { log_ = std::move(log); }
    [[nodiscard]] static bool knows(std::string_view cmd) noexcept;
    /// `snapshot`: of this step; nullptr before the first cycle.
    void ask(std::string_view cmd, ConnectionId connection, const std::string& id, JsonFields& fields, const runtime::Snapshot* snapshot,
             Instant now);
    void forget(ConnectionId connection);
    void step(const runtime::Snapshot* snapshot, Instant now);
    std::optional<Answer> next_answer();

private:
    struct Waiting {
        ConnectionId connection = 0;
        std::string id;
    };
    [[nodiscard]] Result<std::string> drive_parameters(const std::string& axis) const;
    [[nodiscard]] std::string log_lines(std::uint64_t after, std::size_t most) const;
    void look(Instant now);

    MachineLink& machine_;
    std::shared_ptr<const LogTail> log_;
    bool looks_ = false;             ///< it asked for a look that has not come to its end
    std::optional<Instant> looked_;  ///< when the last one did
    std::vector<Waiting> waiting_;   ///< for the look
    std::deque<Answer> answers_;
};

}  // namespace taktwerk::hmi
