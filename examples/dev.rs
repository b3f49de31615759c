use pleach_automaton::network::*;
use pleach_automaton::{Executor, Observer, HybridTime};
use std::ops::ControlFlow;
struct Watch { every: usize, verbose: bool, dmin: f64, cmin: f64, clr: f64 }
type Net = Network<Radio>;
impl Observer<Net> for Watch {
    fn flows(&mut self, n: &Net, _now: HybridTime, _d: f64) -> ControlFlow<record::End> {
        let s = n.snapshot();
        let p = &s.positions;
        for i in 0..p.len() { for j in 0..i { self.dmin = self.dmin.min((p[i]-p[j]).norm()); } self.clr = self.clr.min(n.site().workspace.clearance(p[i])); }
        for c in &s.residuals { self.cmin = self.cmin.min(*c); }
        if self.verbose && s.step % self.every == 0 {
            println!("k={} {:?} task {:?} active {:?} team {:?} path {:?} c {:.4}", s.step, s.phase, s.task, s.active, s.primary_team, s.path, s.residuals.iter().cloned().fold(f64::INFINITY, f64::min));
        }
        for e in n.events() { if !matches!(e, record::MissionEvent::RoleChanged{..}) || self.verbose { println!("  k={} {:?}", s.step, e); } }
        ControlFlow::Continue(())
    }
}
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let text = std::fs::read_to_string(&a[1]).unwrap();
    let mut sc: scenario::Scenario = toml::from_str(&text).unwrap();
    if let Some(m) = a.get(2) { sc.control.max_steps = Some(m.parse().unwrap()); }
    let every: usize = a.get(3).map_or(0, |v| v.parse().unwrap());
    let mut n = Network::new(&sc).unwrap();
    let t = std::time::Instant::now();
    let mut w = Watch { every: every.max(1), verbose: every > 0, dmin: 9e9, cmin: 9e9, clr: 9e9 };
    let end = Executor::new(1e7, 100000).unwrap().run(&mut n, &mut w).unwrap();
    println!("{:?}\nsteps {} wall {:?} times {:?} dmin {:.5} (2rho {:.5}) clr {:.5} cmin {:.5}", end.reason, n.step(), t.elapsed(), n.times(), w.dmin, 2.*n.site().settings.clearance, w.clr, w.cmin);
}
