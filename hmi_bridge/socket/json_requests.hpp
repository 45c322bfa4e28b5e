#pragma once
// The socket's language: one JSON object a line, one answer line for each. Commands go to the gateway, questions are answered
// from the snapshot. Knows no sockets: lines in, lines out. README.md has the table of requests. One thread, not real-time.
//
//   {"id":1,"cmd":"jog","axis":"x","velocity":20,"press":true}   ->  {"id":1,"ok":true}
//   {"id":2,"cmd":"hoem","axis":"x"}  ->  {"id":2,"ok":false,"error":{"code":"request.unknown_command","what":...,"remedy":...}}
//
// Unknown keys are errors: a misspelt "velocity" must not mean "no velocity".

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/time.hpp"
#include "hmi_bridge/gateway/drive_requests.hpp"
#include "hmi_bridge/gateway/gateway.hpp"
#include "hmi_bridge/gateway/measurements.hpp"
#include "hmi_bridge/history/alarm_history.hpp"
#include "hmi_bridge/line_handler.hpp"
#include "hmi_bridge/socket/json_fields.hpp"
#include "hmi_bridge/socket/machine_questions.hpp"
#include "hmi_bridge/socket/scope_requests.hpp"
#include "hmi_bridge/views/view_answers.hpp"

namespace taktwerk::hmi {

class JsonRequests final : public RequestHandler {
public:
    struct Line {
        ConnectionId connection = 0;
        std::string text;     ///< without the newline
        std::string refused;  ///< id of the command that it refuses; empty: none
    };

    /// `wall_utime`: us since 1970; judges the age of requests that say when they were sent ("utime").
    /// `log`: lines for the runtime's log; may be empty.
    JsonRequests(Gateway& gateway, MachineLink& machine, std::function<std::int64_t()> wall_utime,
                 std::function<void(std::string_view)> log = {});

    /// What "simulate" asks of a simulated machine, done within the next cycles. Errors: what the line has wrong.
    using Simulate = std::function<Result<void>(const std::string& line)>;
    /// Without one the machine is real, and the request is refused.
    void set_simulate(Simulate simulate) { simulate_ = std::move(simulate); }
    /// Recordings around alarms; outlives this. Without one there are none.
    void set_recorder(runtime::FlightRecorder* recorder) noexcept { scope_.set_recorder(recorder); }
    void set_run_memory(runtime::RunMemory* memory) noexcept { scope_.set_run_memory(memory); }
    /// For "alarm_history"; outlives this. nullptr: none is kept.
    void set_history(AlarmHistory* history) noexcept { history_ = history; }

    /// The machine builder's own pages; without them there are none.
    void set_views(ViewAnswers views) { views_ = std::move(views); }

    /// For questions: the snapshot of this step, nullptr before the first cycle. Until the next call.
    void observe(const runtime::Snapshot* snapshot) noexcept { snapshot_ = snapshot; }
    /// One line about how the start is getting on, for "hello" and "state".
    void set_progress(std::string progress) { progress_ = std::move(progress); }
    /// For "hello": what runs here.
    struct Part {
        std::string name, version, licence;
    };
    struct About {
        std::string version;
        std::vector<Part> libraries;
    };
    void set_about(About about) { about_ = std::move(about); }
    /// For "hello": where whole states come over LCM (lcm/whole_state_v5_t.lcm), or why they do not.
    struct LcmTold {
        std::string url, why;
        double rate_hz = 0;
        std::int64_t run = 0;
    };
    void set_lcm(LcmTold lcm) { lcm_ = std::move(lcm); }
    /// For "log"; without one it is empty.
    void set_log(std::shared_ptr<const LogTail> log) { questions_.set_log(std::move(log)); }

    void on_open(ConnectionId connection, const Peer& peer) override;
    void on_line(ConnectionId connection, std::string_view line, Instant now) override { on_request(connection, line, now, {}); }
    void on_request(ConnectionId connection, std::string_view line, Instant now, const Arrival& arrival) override;
    void on_close(ConnectionId connection) override;

    /// What drives and the alarm history have answered becomes lines.
    void step(Instant now);
    /// A reply of the gateway with Source::socket.
    void deliver(const CommandReply& reply);
    std::optional<Line> next_line();

private:
    void refuse(ConnectionId connection, const std::string& id, const Error& error);
    void answer(ConnectionId connection, std::string text) { lines_.push_back({connection, std::move(text), {}}); }

    [[nodiscard]] std::string hello(const std::optional<std::string>& stuck, Instant now) const;
    /// True: the request asked about a measurement and is answered.
    bool answer_measure(std::string_view cmd, ConnectionId connection, const std::string& id, JsonFields& fields);
    void ask_history(ConnectionId connection, const std::string& id, JsonFields& fields, Instant now);
    void answer_image(ConnectionId connection, const std::string& id, const std::string& name);
    void ask_drive(DriveRequestKind kind, ConnectionId connection, const std::string& id, JsonFields& fields, Instant now,
                   const Arrival& arrival);
    void simulate(ConnectionId connection, const std::string& id, JsonFields& fields, Instant now, const Arrival& arrival);

    Gateway& gateway_;
    MachineLink& machine_;
    DriveRequests drives_;
    ScopeRequests scope_;
    MachineQuestions questions_;
    About about_;
    LcmTold lcm_;
    std::optional<Instant> began_;
    Measurements measurements_;
    /// What the newest measurement of an axis has come to, as it was answered.
    struct Measured {
        std::uint32_t run = 0;
        std::size_t samples = 0;
        double window = 0;
        std::string text;
    };
    std::map<std::uint16_t, Measured> measured_;
    std::function<std::int64_t()> wall_utime_;
    const runtime::Snapshot* snapshot_ = nullptr;
    std::string progress_;
    Simulate simulate_;
    AlarmHistory* history_ = nullptr;
    ViewAnswers views_;
    std::map<ConnectionId, ClientId> clients_;
    std::map<ClientId, ConnectionId> connections_;
    std::map<ConnectionId, std::string> names_;
    std::deque<Line> lines_;
};

}  // namespace taktwerk::hmi
