//! The thread that draws: it takes the newest question and gives back pictures.

mod drawn;
mod machine;
mod pace;

use std::path::PathBuf;
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use downpour::Backend;
use downpour::weather::{CameraPose, Weather};

pub use drawn::{Drawn, Histogram, PictureView};
pub(crate) use machine::open as open_device;
pub use machine::{Begun, Machine};
pub use pace::{Pace, Rest, SCALES};

/// Choice of the device that draws.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct DeviceChoice {
    /// Kind of device.
    pub backend: Backend,
    /// Part of the name of the GPU to take.
    pub adapter: Option<String>,
}

/// Question for a picture.
#[derive(Clone, Debug)]
pub struct Request {
    /// The weather, whose size is replaced by that of the question.
    pub weather: Arc<Weather>,
    /// Revision of the document that it is of.
    pub revision: u64,
    /// Path by which its files are found.
    pub place: PathBuf,
    /// Other folders of files.
    pub asset_roots: Vec<PathBuf>,
    /// The eye; `None` takes the weather's camera.
    pub eye: Option<CameraPose>,
    /// Time, s.
    pub time_s: f64,
    /// Columns and rows.
    pub size: [u32; 2],
    /// Samples along an edge of a pixel.
    pub samples: u32,
    /// True if the exposure is metered anew.
    pub meters: bool,
    /// True if the drops are listed.
    pub lists_drops: bool,
}

impl Request {
    /// True if it asks for the same as one before it, at another time.
    fn follows(&self, before: &Self) -> bool {
        let of = |it: &Self| (it.revision, it.eye, it.size, it.samples, it.lists_drops);
        Arc::ptr_eq(&self.weather, &before.weather)
            && of(self) == of(before)
            && self.place == before.place
            && self.asset_roots == before.asset_roots
            && !self.meters
    }
}

/// Reason why there is no picture.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fault {
    /// Number of the question.
    pub number: u64,
    /// The message, one line.
    pub message: String,
    /// True if the device is gone and did not come back.
    pub is_fatal: bool,
}

/// Answer to a question.
pub type Answer = Result<Arc<Drawn>, Fault>;

/// The thread, from outside.
#[derive(Debug)]
pub struct Engine {
    shared: Arc<Shared>,
    thread: Option<JoinHandle<()>>,
}

#[derive(Default)]
struct Shared {
    state: Mutex<State>,
    asked: Condvar,
    answered: Condvar,
}

impl std::fmt::Debug for Shared {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Shared").finish_non_exhaustive()
    }
}

#[derive(Default)]
struct State {
    /// The newest question, with its number.
    next: Option<Asked>,
    /// Number of the last question.
    asked: u64,
    /// Number of the last question that was answered.
    answered: u64,
    answer: Option<Answer>,
    is_ended: bool,
    /// Called after each answer.
    wake: Option<Box<dyn Fn() + Send>>,
}

impl Shared {
    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Engine {
    /// Starts the thread; the device is opened with the first question.
    ///
    /// # Errors
    /// The system has no thread left.
    pub fn start(choice: DeviceChoice) -> std::io::Result<Self> {
        let shared = Arc::new(Shared::default());
        let other = Arc::clone(&shared);
        let thread = std::thread::Builder::new()
            .name("downpour-view".to_owned())
            .spawn(move || serve(&other, Machine::new(choice)))?;
        Ok(Self { shared, thread: Some(thread) })
    }

    /// Sets what is called after each answer, from the thread.
    pub fn on_answer(&self, wake: impl Fn() + Send + 'static) {
        self.shared.lock().wake = Some(Box::new(wake));
    }

    /// Asks for a picture; a question that has not been begun is dropped. Returns its number.
    pub fn ask(&self, request: Request) -> u64 {
        let mut state = self.shared.lock();
        state.asked += 1;
        let number = state.asked;
        state.next = Some((number, request));
        self.shared.asked.notify_one();
        number
    }

    /// The newest answer, if it was not taken yet.
    #[must_use]
    pub fn take(&self) -> Option<Answer> {
        self.shared.lock().answer.take()
    }

    /// True while a question has no answer.
    #[must_use]
    pub fn is_busy(&self) -> bool {
        let state = self.shared.lock();
        state.answered < state.asked
    }

    /// Waits until all questions are answered. False if that takes longer than a time.
    #[must_use]
    pub fn wait(&self, most: Duration) -> bool {
        let state = self.shared.lock();
        let busy = |state: &mut State| state.answered < state.asked && !state.is_ended;
        let waited = self.shared.answered.wait_timeout_while(state, most, busy);
        let (state, _) = waited.unwrap_or_else(PoisonError::into_inner);
        state.answered >= state.asked
    }
}

impl Drop for Engine {
    fn drop(&mut self) {
        self.shared.lock().is_ended = true;
        self.shared.asked.notify_one();
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

/// Time of a picture up to which the next one is begun before it is at hand, ms: with longer ones it would show a time long gone.
const MAX_AHEAD_MS: f64 = 50.0;

/// Part of that time until a picture is on its way, up to which something is gained.
const MAX_BEGIN: f64 = 0.5;

/// Part of the time of the last picture for which the next question is waited for, before the thread waits for the device.
const PATIENCE: f64 = 0.75;

/// A question with its number.
type Asked = (u64, Request);

/// Pictures that the thread has under way.
struct Worker {
    machine: Machine,
    /// The picture under way, and whether it was begun before the one before it was at hand.
    begun: Option<(Begun, bool)>,
    /// Time of the last picture until it was on its way, and until it was at hand, ms.
    last_ms: Option<[f64; 2]>,
    /// Time since which the device has had nothing but the picture under way.
    since: Instant,
}

impl Worker {
    fn new(machine: Machine) -> Self {
        Self { machine, begun: None, last_ms: None, since: Instant::now() }
    }

    /// True if it is worth while to begin a picture before the one under way is at hand.
    fn goes_ahead(&self) -> bool {
        // A driver that draws on the CPU has drawn most of a picture when it is on its way.
        self.last_ms.is_some_and(|[begin, all]| all <= MAX_AHEAD_MS && begin <= MAX_BEGIN * all)
    }

    /// Time for which the next question is waited for; `None` is forever.
    fn patience(&self) -> Option<Duration> {
        self.begun.as_ref()?;
        let [_, all] = self.last_ms.filter(|_| self.goes_ahead()).unwrap_or_default();
        Some(Duration::from_secs_f64(1.0e-3 * PATIENCE * all).saturating_sub(self.since.elapsed()))
    }

    /// True if a question may be begun before the picture under way is at hand: the device has no pause then. Only the clock goes on in
    /// such a question: what a hand has changed is to be in the next picture, and not in the one after.
    fn may_go_ahead(&self, next: &Request) -> bool {
        self.goes_ahead() && self.begun.as_ref().is_some_and(|(begun, _)| next.follows(begun.request()))
    }

    /// True if the picture under way was begun ahead and a hand has changed something since: it is not shown.
    fn is_outdated(&self, next: &Request) -> bool {
        self.begun.as_ref().is_some_and(|(begun, is_ahead)| *is_ahead && !next.follows(begun.request()))
    }

    /// Takes one step with the newest question, which is begun or left to the next step. Returns the question if it was left, and an
    /// answer if there is one.
    fn step(&mut self, next: Option<Asked>) -> (Option<Asked>, Option<(u64, Answer)>) {
        let Some((number, request)) = next else {
            return (None, self.finish());
        };
        if self.is_outdated(&request) {
            self.begun = None;
        }
        if self.begun.is_none() {
            self.since = Instant::now();
            self.begun = Some((self.machine.begin(number, request), false));
            return (None, None);
        }
        if !self.may_go_ahead(&request) {
            return (Some((number, request)), self.finish());
        }
        let ahead = self.machine.begin(number, request);
        let answer = self.finish();
        self.begun = Some((ahead, true));
        (None, answer)
    }

    /// Waits for the picture under way, if there is one.
    fn finish(&mut self) -> Option<(u64, Answer)> {
        let (begun, _) = self.begun.take()?;
        let (number, begin_ms) = (begun.number(), begun.begin_ms());
        let answer = self.machine.finish(begun);
        self.since = Instant::now();
        self.last_ms = answer.as_ref().ok().map(|drawn| [begin_ms, drawn.frame_ms]);
        Some((number, answer))
    }
}

/// Work of the thread.
fn serve(shared: &Shared, machine: Machine) {
    let mut worker = Worker::new(machine);
    loop {
        let mut state = shared.lock();
        while state.next.is_none() && !state.is_ended {
            let asked = &shared.asked;
            state = match worker.patience() {
                None => asked.wait(state).unwrap_or_else(PoisonError::into_inner),
                Some(Duration::ZERO) => break,
                Some(time) => asked.wait_timeout(state, time).unwrap_or_else(PoisonError::into_inner).0,
            };
        }
        if state.is_ended {
            return;
        }
        let next = state.next.take();
        drop(state);
        let newest = next.as_ref().map(|(number, _)| *number);
        let step = std::panic::AssertUnwindSafe(|| worker.step(next));
        let (left, answer) = std::panic::catch_unwind(step).unwrap_or_else(|_| {
            let under_way = worker.begun.take().map(|(begun, _)| begun.number());
            worker.machine = Machine::new(worker.machine.choice().clone());
            let message = "internal error while drawing, please report it".to_owned();
            let answer = |number| (number, Err(Fault { number, message, is_fatal: false }));
            (None, newest.or(under_way).map(answer))
        });
        let mut state = shared.lock();
        if state.next.is_none() {
            state.next = left;
        }
        let Some((number, answer)) = answer else { continue };
        state.answered = number;
        state.answer = Some(answer);
        if let Some(wake) = &state.wake {
            wake();
        }
        shared.answered.notify_all();
    }
}

#[cfg(test)]
mod tests;
