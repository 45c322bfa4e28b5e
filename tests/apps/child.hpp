#pragma once
// The built command as a child process: its output, its end. Every wait is bounded; a child still running at the end is killed.

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <string>
#include <vector>

extern char** environ;  // NOLINT(readability-redundant-declaration): POSIX leaves it to the program

namespace taktwerk::apps {

class Child {
public:
    /// Standard output and error come together. Standard input is a pipe that say() writes to.
    explicit Child(std::vector<std::string> arguments) {
        int ends[2] = {-1, -1}, in[2] = {-1, -1};
        if (::pipe2(ends, O_CLOEXEC) != 0 || ::pipe2(in, O_CLOEXEC) != 0) return;
        posix_spawn_file_actions_t actions;
        posix_spawn_file_actions_init(&actions);
        posix_spawn_file_actions_adddup2(&actions, in[0], STDIN_FILENO);
        posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
        posix_spawn_file_actions_adddup2(&actions, ends[1], STDERR_FILENO);
        std::vector<char*> words;
        for (auto& argument : arguments) words.push_back(argument.data());
        words.push_back(nullptr);
        if (::posix_spawnp(&pid_, words.front(), &actions, nullptr, words.data(), environ) != 0) pid_ = 0;
        posix_spawn_file_actions_destroy(&actions);
        ::close(ends[1]);
        ::close(in[0]);
        output_ = ends[0];
        input_ = in[1];
        ::fcntl(output_, F_SETFL, O_NONBLOCK);
    }
    ~Child() {
        if (pid_ > 0) {
            ::kill(pid_, SIGKILL);
            ::waitpid(pid_, nullptr, 0);
        }
        ::close(output_);
        ::close(input_);
    }
    Child(const Child&) = delete;
    Child& operator=(const Child&) = delete;

    void signal(int number) {
        if (pid_ > 0) ::kill(pid_, number);
    }
    /// A line on its standard input. It must still run.
    void say(std::string line) {
        line += '\n';
        if (::write(input_, line.data(), line.size()) < 0) text_ += "(does not listen)";
    }
    /// True when `what` stands in the output, at the latest after `patience`.
    bool says(const std::string& what, std::chrono::milliseconds patience) {
        return until(patience, [&] { return text_.find(what) != std::string::npos; }) || text_.find(what) != std::string::npos;
    }
    /// Exit code; 128 + signal when one ended it; -1 when it still runs after `patience`.
    int wait(std::chrono::milliseconds patience) {
        until(patience, [&] { return ended(); });
        if (!ended()) return -1;
        read();
        return WIFEXITED(status_) ? WEXITSTATUS(status_) : 128 + WTERMSIG(status_);
    }
    [[nodiscard]] pid_t pid() const { return pid_; }
    [[nodiscard]] const std::string& text() const { return text_; }

private:
    template <class Condition>
    bool until(std::chrono::milliseconds patience, Condition condition) {
        const auto end = std::chrono::steady_clock::now() + patience;
        while (!condition()) {
            if (std::chrono::steady_clock::now() >= end) return false;
            pollfd ready{output_, POLLIN, 0};
            ::poll(&ready, 1, 20);
            if ((ready.revents & POLLHUP) != 0 && (ready.revents & POLLIN) == 0) ::poll(nullptr, 0, 5);
            read();
            if (ended()) {
                read();
                return condition();
            }
        }
        return true;
    }
    bool ended() {
        if (pid_ > 0 && ::waitpid(pid_, &status_, WNOHANG) == pid_) pid_ = 0;
        return pid_ == 0;
    }
    void read() {
        char part[4096];
        for (ssize_t got = 0; (got = ::read(output_, part, sizeof part)) > 0;) text_.append(part, static_cast<std::size_t>(got));
    }

    pid_t pid_ = 0;
    int output_ = -1, input_ = -1, status_ = 0;
    std::string text_;
};

}  // namespace taktwerk::apps
