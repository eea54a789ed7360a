// Frames in processes of their own.
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include "composite/sequence/frame_workers.h"

namespace pellucid {
namespace {

struct Heard : FrameListener {
  void note(std::size_t index, const std::string& sentence) override {
    notes.push_back(std::to_string(index) + " " + sentence);
  }
  void stage(std::size_t, const std::string&, double) override { ++stages; }
  void ended(std::size_t index, const FrameOutcome&) override { order.push_back(index); }
  void tick() override {}
  std::vector<std::string> notes;
  std::vector<std::size_t> order;
  int stages = 0;
};

FrameOutcome doneWith(const std::string& out) {
  FrameOutcome outcome;
  outcome.out = out;
  return outcome;
}

TEST(FrameWorkers, OneKeepsWhatItHasAndGoesInOrder) {
  int kept = 0;
  FrameWork work;
  work.count = 5;
  work.work = [&](std::size_t index, const std::string&, FrameVoice& voice) {
    voice.note("here");
    return doneWith(std::to_string(index * 10 + static_cast<std::size_t>(++kept)));
  };
  Heard heard;
  const std::vector<FrameOutcome> outcomes = runFrames(work, heard);
  ASSERT_EQ(outcomes.size(), 5u);
  EXPECT_EQ(outcomes[0].out, "1");
  EXPECT_EQ(outcomes[4].out, "45") << "one process has made all five";
  EXPECT_EQ(kept, 0) << "not this one";
  EXPECT_EQ(heard.order, (std::vector<std::size_t>{0, 1, 2, 3, 4}));
  EXPECT_EQ(heard.notes[4], "4 here");
}

TEST(FrameWorkers, SeveralShareTheFrames) {
  FrameWork work;
  work.count = 8;
  work.jobs = 3;
  work.work = [](std::size_t, const std::string&, FrameVoice&) {
    ::usleep(50000);
    return doneWith(std::to_string(::getpid()));
  };
  Heard heard;
  std::vector<std::string> processes;
  for (const FrameOutcome& outcome : runFrames(work, heard)) processes.push_back(outcome.out);
  std::sort(processes.begin(), processes.end());
  processes.erase(std::unique(processes.begin(), processes.end()), processes.end());
  EXPECT_EQ(processes.size(), 3u);
  EXPECT_EQ(heard.order.size(), 8u);
}

TEST(FrameWorkers, AProcessThatDiesIsAnErrorOfItsFrame) {
  for (const int jobs : {1, 2}) {
    FrameWork work;
    work.count = 4;
    work.jobs = jobs;
    work.work = [](std::size_t index, const std::string&, FrameVoice&) {
      if (index == 1) ::raise(SIGKILL);
      if (index == 2) ::_exit(9);
      return doneWith("fine");
    };
    Heard heard;
    const std::vector<FrameOutcome> outcomes = runFrames(work, heard);
    ASSERT_EQ(outcomes.size(), 4u);
    EXPECT_EQ(outcomes[0].out, "fine");
    EXPECT_EQ(outcomes[1].state, FrameOutcome::State::failed);
    EXPECT_EQ(outcomes[1].code, 137);
    EXPECT_NE(outcomes[1].message.find("signal 9"), std::string::npos) << outcomes[1].message;
    EXPECT_EQ(outcomes[2].code, 9);
    EXPECT_EQ(outcomes[3].out, "fine") << "another process takes over";
  }
}

TEST(FrameWorkers, WhatIsHandedOnIsWaitedFor) {
  FrameWork work;
  work.count = 4;
  work.jobs = 4;
  work.handsOn = true;
  work.work = [](std::size_t index, const std::string& handedOn, FrameVoice&) {
    FrameOutcome outcome = doneWith(handedOn);
    if (index == 0) outcome.state = FrameOutcome::State::failed, outcome.code = 3;
    if (index == 1) outcome.handOn = "a weight";
    return outcome;
  };
  Heard heard;
  const std::vector<FrameOutcome> outcomes = runFrames(work, heard);
  EXPECT_EQ(outcomes[0].out, "");
  EXPECT_EQ(outcomes[1].out, "") << "the first has failed: the second makes it";
  EXPECT_EQ(outcomes[2].out, "a weight");
  EXPECT_EQ(outcomes[3].out, "a weight");
}

TEST(FrameWorkers, AUsageErrorEndsTheRun) {
  FrameWork work;
  work.count = 100;
  work.work = [](std::size_t, const std::string&, FrameVoice&) {
    FrameOutcome outcome;
    outcome.state = FrameOutcome::State::failed;
    outcome.code = 2;
    return outcome;
  };
  Heard heard;
  EXPECT_EQ(runFrames(work, heard).size(), 1u);
}

}  // namespace
}  // namespace pellucid
