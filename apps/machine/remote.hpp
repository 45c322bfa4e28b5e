#pragma once
// What the sub-commands share that talk to a running machine: which one, how answers are printed, which exit code they mean.

#include <functional>
#include <string>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "core/result.hpp"
#include "hmi_bridge/socket/client.hpp"

namespace taktwerk::apps {

struct RemoteOptions {
    std::string machine;  ///< socket path or machine name; empty: the only one that runs
    bool json = false;
};

void add_remote_options(CLI::App& sub, RemoteOptions& options);

/// 5 the machine refused, 6 no running machine, 2 a request the machine does not understand.
[[nodiscard]] int exit_code_of(const Error& error);

/// The answer of a command for people or scripts; returns the exit code.
int report(const RemoteOptions& options, const std::string& done);
int report(const RemoteOptions& options, const Error& error);

/// Connects, and does `work`, which returns the exit code. Where something in an answer is of another type than this version knows, that is told and ends
/// it (socket.bad_answer).
int with_machine(const RemoteOptions& options, const std::function<int(hmi::Client&)>& work);
/// The same where others connect and report. `path`: of the socket.
[[nodiscard]] Result<int> understood(const std::string& path, const std::function<int()>& work);

/// The machine's state (the object of "state").
[[nodiscard]] Result<nlohmann::ordered_json> state_of(hmi::Client& client);
[[nodiscard]] Result<nlohmann::ordered_json> layout_of(hmi::Client& client);

/// A velocity or a position as given on the command line ("20mm/s", "1.2m/min", "20"), in the unit of that axis. An axis that does not
/// exist is left to the machine to refuse. Errors: those of the socket, unit.other, unit.not_a_number.
[[nodiscard]] Result<double> velocity_on(hmi::Client& client, const std::string& axis, const std::string& text);
[[nodiscard]] Result<double> position_on(hmi::Client& client, const std::string& axis, const std::string& text);
/// A value of a parameter or variable, in the unit that its program declared.
[[nodiscard]] Result<double> parameter_value(hmi::Client& client, const std::string& parameter, const std::string& text);
/// No parameter, but a variable that its program lets people write.
[[nodiscard]] bool is_switch(hmi::Client& client, const std::string& name);

}  // namespace taktwerk::apps
