// Any bytes as what a runtime says to the command line: one request has one outcome, at once, and an error of our own has a sentence.
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstdlib>
#include <string>

#include "hmi_bridge/socket/client.hpp"
#include "tests/fuzz/scratch_folder.hpp"

using namespace taktwerk;
using namespace taktwerk::hmi;

namespace {

/// A socket that somebody listens on and says only what the input is.
class Runtime {
public:
    Runtime() : path_((folder_.path() / "demo.sock").string()) {
        sockaddr_un address{};
        address.sun_family = AF_UNIX;
        path_.copy(address.sun_path, sizeof address.sun_path - 1);
        socket_ = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
        if (::bind(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 || ::listen(socket_, 4) != 0) std::abort();
    }
    ~Runtime() { ::close(socket_); }
    Runtime(const Runtime&) = delete;
    Runtime& operator=(const Runtime&) = delete;
    [[nodiscard]] const std::string& path() const { return path_; }
    /// To the client that has connected; then nothing more comes.
    [[nodiscard]] int say(const std::uint8_t* data, std::size_t size) const {
        const int client = ::accept(socket_, nullptr, nullptr);
        if (client < 0 || ::send(client, data, size, MSG_NOSIGNAL) != static_cast<ssize_t>(size)) std::abort();
        ::shutdown(client, SHUT_WR);
        return client;
    }

private:
    fuzz::ScratchFolder folder_;
    std::string path_;
    int socket_ = -1;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size == 0 || size > 4096) return -1;  // fits into what a socket holds
    static const Runtime runtime;
    auto client = Client::connect(runtime.path());
    if (!client) std::abort();
    const int other_end = runtime.say(data, size);
    const auto answer = client->request({{"cmd", "state"}}, std::chrono::seconds{1});
    ::close(other_end);
    if (answer) {
        if (!answer->is_object() || answer->contains("id") || answer->contains("ok")) std::abort();
    } else if (answer.error().code == "socket.timeout") {
        std::abort();  // the end of what is said was not seen
    } else if (answer.error().code.starts_with("socket.") && answer.error().what.empty()) {
        // May be the runtime's own words; then it says nothing by itself.
        if (std::string_view(reinterpret_cast<const char*>(data), size).find("socket.") == std::string_view::npos) std::abort();
    }
    return 0;
}
