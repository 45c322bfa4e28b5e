#pragma once
// A file that is written while the machine runs (trace, capture), on a thread of its own: a slow or full disk holds up this file and
// nothing else. What does not fit meanwhile is dropped and counted where it is handed over (SignalRing, FrameCapture).

#include <functional>
#include <memory>
#include <string>
#include <thread>

#include "core/result.hpp"
#include "core/time.hpp"

namespace taktwerk::apps {

class FileThread {
public:
    /// `what`: "the trace", for sentences. `drain` writes what waits, again and again; its first error goes to `failed`, at once, and ends the draining. `close` is the last
    /// thing that happens, on the thread too: closing a file may wait as well.
    FileThread(std::string what, std::function<Result<void>()> drain, std::function<Result<void>()> close,
               std::function<void(const Error&)> failed);
    ~FileThread();  ///< waits for it
    FileThread(const FileThread&) = delete;
    FileThread& operator=(const FileThread&) = delete;

    enum class End { complete, broken, hangs };
    /// A last drain and the end of the file. `hangs`: the disk did not take it within `patience`; the thread stays in the kernel, and what it
    /// uses must live as long as the process.
    [[nodiscard]] End finish(Duration patience);
    [[nodiscard]] const std::string& what() const { return what_; }

private:
    struct Shared;
    std::string what_;
    std::shared_ptr<Shared> shared_;
    std::thread thread_;
};

}  // namespace taktwerk::apps
