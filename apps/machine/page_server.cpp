#include "apps/machine/page_server.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstring>
#include <utility>
#include <vector>

#include <fmt/format.h>

extern char** environ;  // NOLINT(readability-redundant-declaration): POSIX leaves it to the program

namespace taktwerk::apps {

Result<std::unique_ptr<PageServer>> PageServer::start(const std::string& socket, const std::string& listen, Say say) {
    const auto failed = [](int number) {
        return Error{"page.start", "--hmi", fmt::format("the page's server cannot be started: {}", std::strerror(number)),
                     "The machine runs without it; start one by hand: `taktwerk hmi`."};
    };
    std::array<int, 2> in{-1, -1}, out{-1, -1};
    if (::pipe2(in.data(), O_CLOEXEC) != 0) return failed(errno);
    if (::pipe2(out.data(), O_CLOEXEC) != 0) {
        const int number = errno;
        ::close(in[0]);
        ::close(in[1]);
        return failed(number);
    }
    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_adddup2(&files, in[0], STDIN_FILENO);
    posix_spawn_file_actions_adddup2(&files, out[1], STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&files, out[1], STDERR_FILENO);
    posix_spawn_file_actions_addclosefrom_np(&files, STDERR_FILENO + 1);  // nothing of the bus, whoever forgot CLOEXEC
    posix_spawnattr_t how;
    posix_spawnattr_init(&how);
    // A group of its own: Ctrl-C of the terminal is the machine's, whose end is the server's. What this process ignores, it does not.
    posix_spawnattr_setflags(&how, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETSIGMASK);
    posix_spawnattr_setpgroup(&how, 0);
    sigset_t signals;
    sigfillset(&signals);
    posix_spawnattr_setsigdefault(&how, &signals);
    sigemptyset(&signals);
    posix_spawnattr_setsigmask(&how, &signals);

    std::vector<std::string> arguments{"taktwerk", "hmi", "--end-with-input", "--machine", socket};
    if (!listen.empty()) arguments.insert(arguments.end(), {"--listen", listen});
    std::vector<char*> words;
    for (auto& argument : arguments) words.push_back(argument.data());
    words.push_back(nullptr);
    pid_t pid = 0;
    const int number = ::posix_spawn(&pid, "/proc/self/exe", &files, &how, words.data(), environ);
    posix_spawn_file_actions_destroy(&files);
    posix_spawnattr_destroy(&how);
    ::close(in[0]);
    ::close(out[1]);
    if (number != 0) {
        ::close(in[1]);
        ::close(out[0]);
        return failed(number);
    }
    ::fcntl(out[0], F_SETFL, O_NONBLOCK);
    return std::unique_ptr<PageServer>(new PageServer(pid, in[1], out[0], std::move(say)));
}

PageServer::~PageServer() {
    ::close(input_);
    for (int tries = 0; tries < 50 && !ended(); ++tries) ::poll(nullptr, 0, 10);
    if (!ended()) {
        ::kill(pid_, SIGKILL);
        ::waitpid(pid_, nullptr, 0);
    }
    if (output_ >= 0) ::close(output_);
}

void PageServer::step() {
    if (told_) return;
    if (output_ >= 0) read();
    if (output_ >= 0) return;
    // It holds the pipe's other end as long as it lives: how it ended is known a moment after the pipe's end.
    int status = 0;
    if (::waitpid(pid_, &status, WNOHANG) == pid_) pid_ = 0;
    else if (++looks_after_the_end_ < looks_for_its_end) return;
    told_ = true;
    const auto how = pid_ > 0              ? std::string("it has closed its output")
                     : WIFSIGNALED(status) ? fmt::format("ended by signal {} ({})", WTERMSIG(status), ::strsignal(WTERMSIG(status)))
                                           : fmt::format("ended with exit code {}", WEXITSTATUS(status));
    say_(fmt::format("the page's server is gone: {}. The machine runs on; `taktwerk hmi` starts another", how));
}

bool PageServer::ended() {
    if (pid_ > 0 && ::waitpid(pid_, nullptr, WNOHANG) == pid_) pid_ = 0;
    return pid_ <= 0;
}

void PageServer::read() {
    std::array<char, 4096> part;
    const auto got = ::read(output_, part.data(), part.size());
    if (got < 0 && (errno == EAGAIN || errno == EINTR)) return;
    if (got <= 0) {
        ::close(std::exchange(output_, -1));
        if (!text_.empty()) say_(std::exchange(text_, {}));
        return;
    }
    text_.append(part.data(), static_cast<std::size_t>(got));
    for (auto end = text_.find('\n'); end != std::string::npos; end = text_.find('\n')) {
        if (end > 0) say_(text_.substr(0, end));
        text_.erase(0, end + 1);
    }
    if (text_.size() > longest_line) text_.clear();
}

}  // namespace taktwerk::apps
