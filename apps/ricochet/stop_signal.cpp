#include "stop_signal.hpp"

#include <unistd.h>

#include <csignal>

namespace ricochet::program {

namespace {

volatile std::sig_atomic_t received = 0;

void receive(int signal) {
  if (received != 0) _exit(128 + signal);
  received = signal;
  constexpr char text[] = "\nricochet: stopping at the end of this step; once more stops at once\n";
  static_cast<void>(!write(STDERR_FILENO, text, sizeof(text) - 1));
}

// SIGHUP: the terminal or the connection to it has gone.
constexpr int stop_signals[] = {SIGINT, SIGTERM, SIGHUP};

/// Threads that libraries start before main() begins (OpenBLAS does) inherit what is blocked here: signals are for the
/// main thread alone, which holds them back while METIS works (linear_algebra/sparse_cholesky.cpp).
sigset_t before_libraries;
void hold_signals(int, char**, char**) {
  sigset_t held;
  sigemptyset(&held);
  for (const int signal : stop_signals) sigaddset(&held, signal);
  sigprocmask(SIG_BLOCK, &held, &before_libraries);
}
__attribute__((section(".preinit_array"), used)) void (*const hold_signals_first)(int, char**, char**) = hold_signals;

}  // namespace

void let_signals_come() {
  sigprocmask(SIG_SETMASK, &before_libraries, nullptr);
}

void catch_stop_signals() {
  // A file that may not grow any more is an error like a full disk.
  std::signal(SIGXFSZ, SIG_IGN);
  for (const int signal : stop_signals) {
    struct sigaction action {};
    action.sa_handler = receive;
    action.sa_flags = SA_RESTART;
    // A signal that the caller ignores (nohup, a job in the background) stays ignored.
    struct sigaction before {};
    if (sigaction(signal, nullptr, &before) == 0 && before.sa_handler != SIG_IGN) sigaction(signal, &action, nullptr);
  }
}

int stop_signal() {
  return received;
}

}  // namespace ricochet::program
