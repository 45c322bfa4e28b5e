#pragma once
// Lines that somebody types or pipes into a running command, read from a descriptor without ever waiting for it.

#include <optional>
#include <string>

namespace taktwerk::apps {

class LineInput {
public:
    /// Of this descriptor; -1: nothing ever comes.
    explicit LineInput(int descriptor);
    /// For poll(2); -1 once the other side has closed it.
    [[nodiscard]] int descriptor() const noexcept { return descriptor_; }
    /// The next whole line that has arrived, without its end.
    [[nodiscard]] std::optional<std::string> next();

private:
    int descriptor_;
    std::string waiting_;
};

}  // namespace taktwerk::apps
