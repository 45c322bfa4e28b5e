#pragma once
// The other end of the local socket, for the command line and tests: one request, one answer. Blocks up to a time-out; for
// programs of people, never for the runtime.
//
//   auto client = Client::connect("demo");
//   auto answer = client->request({{"cmd", "jog"}, {"axis", "x"}, {"velocity", 20}, {"press", true}});
//   if (!answer) std::cerr << answer.error().text();

#include <cstdint>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include "core/result.hpp"
#include "core/time.hpp"

namespace taktwerk::hmi {

class Client {
public:
    static constexpr Duration patience = std::chrono::seconds{3};  ///< longer than the gateway waits for the cycle

    /// A socket's path, a machine's name, or empty when only one machine runs.
    /// Errors: socket.not_found, socket.ambiguous, socket.no_runtime, socket.no_permission, socket.connect.
    static Result<Client> connect(std::string_view machine_or_path);
    Client(Client&& other) noexcept;
    Client& operator=(Client&& other) noexcept;
    ~Client();

    /// Sends `request` with the next "id" and the time, waits for its answer. The answer's object without "id" and "ok".
    /// Errors: what the runtime says (command..., request..., state.not_yet); socket.timeout, socket.closed, socket.bad_answer.
    Result<nlohmann::ordered_json> request(nlohmann::json request, Duration timeout = patience);

    [[nodiscard]] const std::string& path() const noexcept { return path_; }

private:
    Client(int socket, std::string path) : socket_(socket), path_(std::move(path)) {}
    Result<std::string> read_line(std::int64_t deadline_ns);

    int socket_ = -1;
    std::string path_;
    std::string in_;
    std::int64_t next_id_ = 1;
};

}  // namespace taktwerk::hmi
