//! The friendly competition's list (ARCH-COMP, categories AFF and NLN).

mod gearbox;
mod nonlinear;
mod platoon;
mod rendezvous;

use std::ops::ControlFlow;
use std::time::Instant;

use pleach_automaton::{Automaton, Name, Record};
use pleach_verify::reach::{self, Forbidden, Settings, StateSet, Uncertain};

type TestResult<T> = Result<T, Box<dyn std::error::Error>>;

/// An instance of the list.
pub struct Instance {
    automaton: Automaton<Name, Name, Record>,
    start: StateSet,
    uncertain: Vec<Uncertain>,
    forbidden: Vec<Forbidden>,
    settings: Settings,
}

fn main() -> TestResult<()> {
    let only = std::env::args().nth(1);
    let list: Vec<(&str, Instance)> = vec![
        ("GRBX01", gearbox::shift((0.0001,0.0001), Settings { horizon: 0.2, step: 0.0005, ..Settings::default() })?),
        ("LALO20-001", nonlinear::laub_loomis(0.01, 4.5, Settings { horizon: 20.0, step: 0.5, ..Settings::default() })?),
        ("LALO20-005", nonlinear::laub_loomis(0.05, 4.5, Settings { horizon: 20.0, step: 0.5, ..Settings::default() })?),
        ("LALO20-01", nonlinear::laub_loomis(0.1, 5.0, Settings { horizon: 20.0, step: 0.5, ..Settings::default() })?),
        ("LOVO", nonlinear::lotka_volterra(Settings { horizon: 3.64, step: 0.5, ..Settings::default() })?),
        ("ROBE1", nonlinear::robertson(1e2,1e3,Settings { horizon: 40.0, step: 0.5, ..Settings::default() })?),
        ("QUAD01", nonlinear::quadrotor(0.1,Settings { horizon: 5.0, step: 0.1, ..Settings::default() })?),
        ("CVDP22", nonlinear::van_der_pol([(1.25,1.55);2],(60.0,80.0),3.7,Settings { horizon: 7.0, step: 0.1, ..Settings::default() })?),
        ("CVDP23", nonlinear::van_der_pol([(1.25,1.55);2],(1.0,3.0),2.75,Settings { horizon: 7.0, step: 0.1, ..Settings::default() })?),

        ("PLAD01-BND42", platoon::deterministic(42.0, Settings { horizon: 20.0, step: 0.02, ..Settings::default() })?),
        ("PLAD01-BND30", platoon::deterministic(30.0, Settings { horizon: 20.0, step: 0.02, ..Settings::default() })?),
        ("SRNA01", rendezvous::mission(None, Settings { horizon: 300.0, step: 0.1, ..Settings::default() })?),
        ("SRA01", rendezvous::mission(Some((120.0,120.0)), Settings { horizon: 300.0, step: 0.1, ..Settings::default() })?),
        ("SRA02", rendezvous::mission(Some((120.0,125.0)), Settings { horizon: 300.0, step: 0.1, ..Settings::default() })?),
    ];
    for (name, mut instance) in list {
        let v = |n: &str| std::env::var(n).ok().and_then(|t| t.parse::<f64>().ok());
        { let st = &mut instance.settings; if let Some(x)=v("STEP") {st.step=x;} if let Some(x)=v("CL") {st.clusters=x as usize;} if let Some(x)=v("GEN") {st.generators=x as usize;} if let Some(x)=v("TOL") {st.tolerance=x;} if let Some(x)=v("ORD") {st.order=x as usize;} if let Some(x)=v("DEG") {st.degree=x as usize;} }
        if only.as_ref().is_some_and(|o| !name.starts_with(o.as_str())) { continue; }
        let begin = Instant::now();
        let model = reach::Model::with_uncertain(&instance.automaton, &instance.uncertain)?;
        let p = reach::prove(&model, std::slice::from_ref(&instance.start), &instance.forbidden, &instance.settings, &mut |_| ControlFlow::Continue(()))?;
        let e = &p.enclosure;
        let bad = p.doubts.len(); let first = p.doubts.first().map(|d| (d.forbidden, d.time, d.states.iter().map(|i| i.to_string()).collect::<Vec<_>>()));
        println!("clear {:?}", p.clearances);
        println!("{name}: {:?} bad {bad}  visits {} segments {} time {:?}", e.ending, e.visits.len(), e.visits.iter().map(|v| v.segments.len()).sum::<usize>(), begin.elapsed());
        println!("{first:?}");
        for v in &e.visits {
            println!("  {} {} {:?}", model.locations()[v.location].name, v.elapsed, v.segments.len());
            if v.segments.len() > 1 { let s = &v.segments[v.segments.len()-1]; println!("   {:?}", s.set.hull().unwrap().iter().map(|i| i.to_string()).collect::<Vec<_>>()); }
        }
    }
    Ok(())
}
