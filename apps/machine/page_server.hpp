#pragma once
// `taktwerk run --hmi`: the page's server as a process of its own, beside the machine. It hangs, dies or is killed and the machine runs on; it ends with
// the run, however that ends: its standard input is a pipe that this process holds. Not real-time; the service side's thread.

#include <sys/types.h>

#include <functional>
#include <memory>
#include <string>

#include "core/result.hpp"

namespace taktwerk::apps {

class PageServer {
public:
    using Say = std::function<void(const std::string& line)>;  ///< what it says, and how it ended

    /// `socket`: of the machine that it shows. `listen`: ADDRESS:PORT; empty: 127.0.0.1, port 8080 or the next that is free. Errors: page.start.
    static Result<std::unique_ptr<PageServer>> start(const std::string& socket, const std::string& listen, Say say);
    /// Waits half a second for it, then kills it.
    ~PageServer();
    PageServer(const PageServer&) = delete;
    PageServer& operator=(const PageServer&) = delete;

    /// Hands on what it has said. Never waits.
    void step();

private:
    PageServer(pid_t pid, int input, int output, Say say) : pid_(pid), input_(input), output_(output), say_(std::move(say)) {}
    void read();
    bool ended();

    static constexpr std::size_t longest_line = 4096;
    static constexpr int looks_for_its_end = 500;

    pid_t pid_;
    int input_, output_;
    Say say_;
    std::string text_;
    int looks_after_the_end_ = 0;
    bool told_ = false;  // that it is gone
};

}  // namespace taktwerk::apps
