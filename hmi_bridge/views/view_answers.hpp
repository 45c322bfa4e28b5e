#pragma once
// What the socket answers to `views` and `view_image` (README.md of hmi_bridge): put together once, constant while the machine runs. Not real-time.

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.hpp"
#include "hmi_bridge/view_config.hpp"
#include "hmi_bridge/views/view_values.hpp"

namespace taktwerk::hmi {

class ViewAnswers {
public:
    ViewAnswers() = default;  ///< no view
    /// Errors: those of check(), of the first picture that cannot be read any more.
    static Result<ViewAnswers> make(const std::vector<View>& views, const ViewValues& values);

    /// A JSON array.
    [[nodiscard]] const std::string& views() const noexcept { return views_; }
    /// The members of the answer, without braces: `"media_type":"image/png","data":"..."`; nothing: no widget shows such a picture. `type` is
    /// taken: the page's server says by it what kind a message is.
    [[nodiscard]] std::optional<std::string_view> image(std::string_view name) const;
    [[nodiscard]] std::vector<std::string> images() const;

private:
    std::string views_ = "[]";
    std::map<std::string, std::string, std::less<>> images_;
};

}  // namespace taktwerk::hmi
