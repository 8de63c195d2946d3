#include "ricochet/base/ranks.hpp"

namespace ricochet {

void Ranks::run_collectively(const std::function<void()>& work) const {
  if (!are_several()) {
    work();
    return;
  }
  std::optional<Error> own;
  try {
    work();
  } catch (const Error& problem) {
    own = problem;
  }
  if (!any(own.has_value())) return;
  ForEach<std::int64_t> messages(static_cast<std::size_t>(size()));
  if (own) {
    const std::string text = own->what();
    std::vector<std::int64_t> message{std::int64_t(own->kind())};
    message.insert(message.end(), text.begin(), text.end());
    std::ranges::fill(messages, message);
  }
  for (const std::vector<std::int64_t>& message : exchange(std::move(messages))) {
    if (message.empty()) continue;
    throw Error(static_cast<ErrorKind>(message.front()), std::string(message.begin() + 1, message.end()));
  }
}

std::vector<std::string> Ranks::gather_texts(const std::string& own) const {
  ForEach<std::int64_t> messages(static_cast<std::size_t>(size()));
  messages.front().assign(own.begin(), own.end());
  std::vector<std::string> result;
  for (const std::vector<std::int64_t>& text : exchange(std::move(messages)))
    result.emplace_back(text.begin(), text.end());
  return is_first() ? result : std::vector<std::string>{};
}

void Ranks::sum(std::span<double> values) const {
  if (!are_several()) return;
  const std::vector<Reduction> by(values.size(), Reduction::sum);
  reduce(values, by);
}

}  // namespace ricochet
