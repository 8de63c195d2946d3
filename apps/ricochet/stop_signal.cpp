#include "stop_signal.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <ctime>
#include <system_error>
#include <thread>

#include "ricochet/base/interruption.hpp"

namespace ricochet::program {

namespace {

/// Milliseconds for a step to complete; of two seconds in all, the rest is for the output after it.
constexpr int patience = 1200;

constexpr std::chrono::milliseconds same_request{250};

std::atomic<int> received = 0;
std::atomic<const char*> message_prefix = nullptr;  ///< null: no messages
std::atomic<bool> steps_end = false;

void print_message(const std::string& what) {
  if (const char* name = message_prefix) interruption::write_to_stderr(fmt::format("\n{}: {}\n", name, what).c_str());
}

// SIGHUP: the terminal or the connection to it is gone.
constexpr int stop_signals[] = {SIGINT, SIGTERM, SIGHUP};

/// Blocks these signals in all threads, so that one thread can wait for them: threads that libraries start before
/// main() (OpenBLAS does) inherit the mask.
void block_signals(int, char**, char**) {
  sigset_t blocked;
  sigemptyset(&blocked);
  for (const int signal : stop_signals) sigaddset(&blocked, signal);
  sigprocmask(SIG_BLOCK, &blocked, nullptr);
}
__attribute__((section(".preinit_array"), used)) void (*const block_signals_first)(int, char**, char**) = block_signals;

/// Returns the next signal, or 0 after so many milliseconds (−1: no limit).
int next_signal(const sigset_t& awaited, int milliseconds) {
  const struct timespec limit { milliseconds / 1000, milliseconds % 1000 * 1000000L };
  for (;;) {
    const int signal = milliseconds < 0 ? sigwaitinfo(&awaited, nullptr) : sigtimedwait(&awaited, nullptr, &limit);
    if (signal > 0) return signal;
    if (errno != EINTR) return 0;
  }
}

/// Returns, like next_signal(), another request to stop after the first signal, which arrived at the given instant.
/// Programs such as timeout send a signal to a process and to its group: the same signal repeated at once is the same
/// request.
int next_request(const sigset_t& awaited, int first, std::chrono::steady_clock::time_point instant, int milliseconds) {
  using std::chrono::steady_clock;
  const auto end = steady_clock::now() + std::chrono::milliseconds(milliseconds);
  for (int left = milliseconds;;) {
    const int signal = next_signal(awaited, left);
    if (signal != first || steady_clock::now() > instant + same_request) return signal;
    if (milliseconds < 0) continue;
    const auto rest = std::chrono::duration_cast<std::chrono::milliseconds>(end - steady_clock::now()).count();
    left = std::max(0, int(rest));
  }
}

/// Cleans up and ends the process, on a separate thread: another signal must not wait for it.
void end_process(int signal) {
  try {
    std::thread([signal] {
      if (interruption::run_actions()) _exit(128 + signal);
    }).detach();
  } catch (const std::system_error&) {  // no room for a thread
    _exit(128 + signal);
  }
}

void wait(const sigset_t& awaited) {
  const int first = next_signal(awaited, -1);
  if (first == 0) return;
  const auto instant = std::chrono::steady_clock::now();
  if (const int second = next_request(awaited, first, instant, 0); second != 0) _exit(128 + second);
  received = first;
  if (interruption::has_stopping_points()) {
    print_message("stopping at the end of this step; another signal stops at once");
    if (const int second = next_request(awaited, first, instant, steps_end ? -1 : patience); second != 0)
      _exit(128 + second);
  } else {
    print_message(fmt::format("stopped by SIG{}", sigabbrev_np(first)));
  }
  end_process(first);
  const int second = next_request(awaited, first, instant, -1);
  _exit(128 + second);
}

}  // namespace

void wait_for_stop_signals(const char* program_name) {
  message_prefix = program_name;
  // A file that reached its size limit is an error like a full disk.
  std::signal(SIGXFSZ, SIG_IGN);
  sigset_t awaited;
  sigemptyset(&awaited);
  for (const int signal : stop_signals) {
    struct sigaction before {};
    // A signal that the caller ignores (nohup, a job in the background) stays ignored.
    if (sigaction(signal, nullptr, &before) == 0 && before.sa_handler != SIG_IGN) sigaddset(&awaited, signal);
  }
  try {
    std::thread(wait, awaited).detach();
  } catch (const std::system_error&) {  // no room for a thread: signals end the process in the usual way
    pthread_sigmask(SIG_UNBLOCK, &awaited, nullptr);
  }
}

void set_signal_program_name(const char* program_name) { message_prefix = program_name; }

void remove_step_time_limit() { steps_end = true; }

int stop_signal() { return received; }

}  // namespace ricochet::program
