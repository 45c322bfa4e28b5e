#include "hmi_bridge/socket/client.hpp"

#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include <fmt/format.h>

#include "core/clock.hpp"
#include "hmi_bridge/socket/socket_path.hpp"
#include "hmi_bridge/wall_clock.hpp"

namespace taktwerk::hmi {
namespace {

std::int64_t now_ns() { return SystemClock{}.now().time_since_epoch().count(); }

/// A value of the error object, whatever the other end has put there.
std::string text_of(const nlohmann::ordered_json& object, const char* key) {
    const auto found = object.find(key);
    return found != object.end() && found->is_string() ? found->get<std::string>() : std::string{};
}

}  // namespace

Result<Client> Client::connect(std::string_view machine_or_path) {
    auto path = find_socket(machine_or_path);
    if (!path) return path.error();
    sockaddr_un address{};
    if (path->size() >= sizeof address.sun_path)
        return Error{"socket.connect", *path, "the path is too long for a socket", "Give a shorter path."};
    address.sun_family = AF_UNIX;
    std::memcpy(address.sun_path, path->c_str(), path->size());
    const int socket = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
    if (socket >= 0 && ::connect(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0) return Client(socket, *path);
    const int why = errno;
    if (socket >= 0) ::close(socket);
    if (why == ENOENT || why == ECONNREFUSED)
        return Error{"socket.no_runtime", *path, why == ENOENT ? "there is no such socket" : "nobody listens on this socket any more",
                     "Is the runtime running? Start it with `taktwerk run FILE`."};
    if (why == EACCES || why == EPERM)
        return Error{"socket.no_permission", *path, "this user may not open the command socket",
                     "Become a member of the socket's group, or use the user that runs the machine."};
    return Error{"socket.connect", *path, fmt::format("cannot connect: {}", std::strerror(why)),
                 "See that the path is the socket of a running machine."};
}

Client::Client(Client&& other) noexcept
    : socket_(std::exchange(other.socket_, -1)), path_(std::move(other.path_)), in_(std::move(other.in_)), next_id_(other.next_id_) {}

Client& Client::operator=(Client&& other) noexcept {
    std::swap(socket_, other.socket_);
    std::swap(path_, other.path_);
    std::swap(in_, other.in_);
    std::swap(next_id_, other.next_id_);
    return *this;
}

Client::~Client() {
    if (socket_ >= 0) ::close(socket_);
}

Result<std::string> Client::read_line(std::int64_t deadline_ns) {
    for (;;) {
        if (const auto end = in_.find('\n'); end != std::string::npos) {
            auto line = in_.substr(0, end);
            in_.erase(0, end + 1);
            return line;
        }
        const auto left = deadline_ns - now_ns();
        if (left <= 0)
            return Error{"socket.timeout", path_, "the runtime did not answer in time",
                         "Look at the runtime's output; it may be overloaded or stopped in a debugger."};
        pollfd wait{socket_, POLLIN, 0};
        if (::poll(&wait, 1, static_cast<int>(std::min<std::int64_t>(left / 1'000'000 + 1, 10'000))) <= 0) continue;
        char buffer[64 * 1024];
        const auto got = ::recv(socket_, buffer, sizeof buffer, 0);
        if (got > 0) in_.append(buffer, static_cast<std::size_t>(got));
        else if (got == 0 || errno != EINTR)
            return Error{"socket.closed", path_, "the runtime has closed the connection", "It has probably ended: look at its output."};
    }
}

Result<nlohmann::ordered_json> Client::request(nlohmann::json request, Duration timeout) {
    const auto id = next_id_++;
    request["id"] = id;
    request["utime"] = wall_utime();
    const auto line = request.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
    for (std::size_t done = 0; done < line.size();) {
        const auto sent = ::send(socket_, line.data() + done, line.size() - done, MSG_NOSIGNAL);
        if (sent < 0 && errno == EINTR) continue;
        if (sent <= 0) break;  // what the runtime said before it closed is still to be read
        done += static_cast<std::size_t>(sent);
    }
    const auto deadline = now_ns() + timeout.count();
    for (;;) {
        auto answer_line = read_line(deadline);
        if (!answer_line) return answer_line.error();
        auto answer = nlohmann::ordered_json::parse(*answer_line, nullptr, false);
        const auto bad = [&] {
            return Error{"socket.bad_answer", path_, "the answer is not what this version understands",
                         "Use the command line of the runtime's version."};
        };
        if (!answer.is_object() || !answer.contains("id") || !answer.contains("ok") || !answer["ok"].is_boolean()) return bad();
        const auto& answered = answer["id"];
        const bool of_connection = answered.is_null();                                      // e.g. too many clients
        if (!of_connection && !(answered.is_number_integer() && answered == id)) continue;  // of a request that was given up
        if (!answer["ok"].get<bool>()) {
            if (!answer.contains("error") || !answer["error"].is_object()) return bad();
            const auto& error = answer["error"];
            return Error{text_of(error, "code"), text_of(error, "subject"), text_of(error, "what"), text_of(error, "remedy")};
        }
        answer.erase("id");
        answer.erase("ok");
        return answer;
    }
}

}  // namespace taktwerk::hmi
