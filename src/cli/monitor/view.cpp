#include "cli/monitor/view.hpp"

#include "cli/monitor/texts.hpp"
#include "cli/texts.hpp"

#include <algorithm>
#include <utility>

namespace blactl::cli {
namespace {

/// The last line of a text that ends with a line break.
std::string last_line(std::string_view text) {
  text = text.substr(0, text.find_last_not_of('\n') + 1);
  return std::string(text.substr(text.rfind('\n') + 1));
}

std::vector<ScreenLine> help_lines() {
  std::vector<ScreenLine> out;
  const std::string help = say<texts::monitor_help>();
  for (std::size_t at = 0; at < help.size();) {
    const std::size_t end = std::min(help.find('\n', at), help.size());
    out.push_back({{"  " + help.substr(at, end - at)}});
    at = end + 1;
  }
  return out;
}

} // namespace

MonitorView::MonitorView(std::unique_ptr<Screen> screen, const Reporter& reporter,
                         std::string opened, Time begin)
    : screen_(std::move(screen)), reporter_(reporter), opened_(std::move(opened)), begin_(begin),
      table_(begin), keys_(say<texts::monitor_keys>()) {
  reporter_.hold(&held_);
}

MonitorView::~MonitorView() {
  screen_.reset();
  reporter_.hold(nullptr);
  if (!held_.empty()) {
    reporter_.repeat(held_);
  }
}

void MonitorView::take(std::vector<fleet::LiveServo> servos, Time now) {
  history_.take(servos, now);
  if (!paused_) {
    table_.take(std::move(servos));
  }
  draw(now);
}

void MonitorView::on_other_keys(std::function<void(Key)> hook, std::string keys) {
  other_keys_ = std::move(hook);
  keys_ = std::move(keys);
}

bool MonitorView::press(Key key) {
  switch (key) {
  case U'q': return false;
  case U'?': page_ = page_ == Page::help ? Page::table : Page::help; break;
  case keys::escape:
  case keys::back: page_ = Page::table; break;
  case keys::enter: page_ = table_.chosen() != nullptr ? Page::graphs : page_; break;
  default:
    if (!table_.press(key) && other_keys_) {
      other_keys_(key);
    }
    break;
  }
  return true;
}

bool MonitorView::take_keys(Time now) {
  while (const auto key = screen_->read()) {
    if (*key == U'p' || *key == U' ') {
      paused_ = paused_ ? std::nullopt : std::optional(now);
    } else if (!press(*key)) {
      return false;
    }
  }
  draw(now);
  return true;
}

std::optional<dronecan::NodeId> MonitorView::shown() const {
  const fleet::LiveServo* chosen = table_.chosen();
  return page_ == Page::graphs && chosen != nullptr ? std::optional(chosen->servo.id)
                                                    : std::nullopt;
}

ScreenLine MonitorView::title(Time now) const {
  ScreenLine line{{say<texts::monitor_title>(opened_, table_.size()), Look::head}};
  if (page_ == Page::graphs && table_.chosen() != nullptr) {
    const auto& servo = table_.chosen()->servo;
    line = {{fmt::format("{} {}  {}  ", say<texts::column_node>(), servo.id.value(),
                         servo.identity.model()),
             Look::head},
            state_of(*table_.chosen(), now, begin_)};
  } else {
    line.push_back({"  " + say<texts::monitor_sorted>(table_.order())});
  }
  if (!table_.shown().empty()) {
    line.push_back({"  " + table_.shown()});
  }
  line.insert(line.end(), told_.begin(), told_.end());
  if (paused_) {
    line.push_back({"  " + say<texts::monitor_paused>(), Look::warning});
  }
  return line;
}

/// The latest note, else the keys.
ScreenLine MonitorView::footer() const {
  if (!held_.empty()) {
    return {{last_line(held_), Look::warning}};
  }
  return {{page_ == Page::table ? keys_ : say<texts::monitor_keys_one>(), Look::dim}};
}

std::vector<ScreenLine> MonitorView::body(std::size_t height, Time now) {
  switch (page_) {
  case Page::help: return help_lines();
  case Page::graphs:
    if (const auto* chosen = table_.chosen()) {
      return graphs(*chosen, history_, now, height, screen_->width(), reporter_.page().unicode);
    }
    break;
  case Page::table: break;
  }
  return table_.lines(height, now);
}

void MonitorView::draw(Time now) {
  const Time then = paused_.value_or(now);
  screen_->fit();
  const std::size_t height = std::max<std::size_t>(screen_->height(), 3);
  std::vector<ScreenLine> lines = body(height - 2, then);
  lines.insert(lines.begin(), title(then));
  lines.resize(height - 1);
  lines.push_back(footer());
  screen_->draw(lines);
}

} // namespace blactl::cli
