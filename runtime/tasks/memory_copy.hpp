#pragma once
// Places of a program's memory as a slow task leaves them: copied after a run, taken when the run is applied.

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <span>
#include <utility>
#include <vector>

namespace taktwerk::runtime {

class MemoryCopy {
public:
    struct Source {
        const void* address = nullptr;
        std::size_t size = 0;
    };
    explicit MemoryCopy(std::vector<Source> sources) : sources_(std::move(sources)) {
        std::size_t size = 0;
        for (const auto& source : sources_) size += source.size;
        read_.resize(size);
        applied_.resize(size);
        read();
        apply();
    }

    /// By the task, after a run.
    void read() noexcept {
        auto* to = read_.data();
        for (const auto& source : sources_) {
            std::memcpy(to, source.address, source.size);
            to += source.size;
        }
    }
    /// By the cycle.
    void apply() noexcept { std::copy(read_.begin(), read_.end(), applied_.begin()); }
    /// One after the other.
    [[nodiscard]] std::span<const std::byte> applied() const noexcept { return applied_; }

private:
    std::vector<Source> sources_;
    std::vector<std::byte> read_, applied_;
};

}  // namespace taktwerk::runtime
