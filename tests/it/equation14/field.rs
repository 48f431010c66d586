//! Fields of extinction, written a second time as plain functions.

/// Function of the distance; at a break the second argument, a point inside the piece, chooses the side.
pub type Function = Box<dyn Fn(f64, f64) -> f64>;

/// Field written twice: as in a case and as a function.
pub struct Field {
    pub text: String,
    pub breaks: Vec<f64>,
    pub value: Function,
    /// Number of values: one, or one per piece.
    pub shape: Shape,
}

#[derive(Clone, Copy, PartialEq)]
pub enum Shape {
    Constant(f64),
    Steps,
    Other,
}

pub fn constant(x: f64) -> Field {
    let text = format!("constant.{} = {x}", "value");
    Field { text, breaks: Vec::new(), value: Box::new(move |_, _| x), shape: Shape::Constant(x) }
}

fn piece(breaks: &[f64], inside: f64) -> usize {
    breaks.partition_point(|&b| b <= inside).clamp(1, breaks.len() - 1) - 1
}

pub fn steps(breaks: &[f64], values: &[f64]) -> Field {
    let text = format!("piecewise-constant = {{ breaks = {breaks:?}, values = {values:?} }}");
    let (b, v) = (breaks.to_vec(), values.to_vec());
    let value = Box::new(move |_: f64, inside: f64| v[piece(&b, inside)]);
    Field { text, breaks: breaks.to_vec(), value, shape: Shape::Steps }
}

fn through(knots: Vec<f64>, values: Vec<f64>) -> Function {
    Box::new(move |t, inside| {
        let i = piece(&knots, inside);
        let u = (t - knots[i]) / (knots[i + 1] - knots[i]);
        (1.0 - u) * values[i] + u * values[i + 1]
    })
}

pub fn lines(knots: &[f64], values: &[f64]) -> Field {
    let text = format!("piecewise-linear = {{ knots = {knots:?}, values = {values:?} }}");
    let value = through(knots.to_vec(), values.to_vec());
    Field { text, breaks: knots.to_vec(), value, shape: Shape::Other }
}

pub fn smooth(text: &str, f: impl Fn(f64) -> f64 + 'static) -> Field {
    let value = Box::new(move |t: f64, _: f64| f(t));
    Field { text: text.into(), breaks: Vec::new(), value, shape: Shape::Other }
}

pub fn no_control() -> Field {
    Field { text: "none = {}".into(), ..constant(0.0) }
}

/// Returns lines through σ_t at n points, the ends included.
pub fn explorers(medium: &Field, length: f64, n: usize) -> Field {
    let knots: Vec<f64> = (0..n).map(|i| length * i as f64 / (n - 1) as f64).collect();
    let values: Vec<f64> = knots.iter().map(|&t| (medium.value)(t, t)).collect();
    let text = format!("explorers.points = {n}");
    let level = n == 2 && values[0] == values[1];
    let shape = if level { Shape::Constant(values[0]) } else { Shape::Other };
    Field { text, breaks: knots.clone(), value: through(knots, values), shape }
}

pub fn homogeneous() -> Field {
    constant(0.5)
}

pub fn layers() -> Field {
    steps(&[0.0, 2.0, 3.0, 6.0, 7.0, 10.0], &[0.1, 1.0, 0.4, 0.0, 0.25])
}

pub fn hills() -> Field {
    lines(&[0.0, 1.0, 2.5, 4.0], &[0.2, 1.5, 0.4, 0.9])
}

pub fn atmosphere() -> Field {
    smooth("exponential = { extinction = 2.0, rate = 0.7 }", |t| 2.0 * (-0.7 * t).exp())
}

pub fn blob() -> Field {
    smooth("gaussian = { peak = 1.2, centre = 2.2, width = 0.6 }", |t| {
        let z = (t - 2.2) / 0.6;
        1.2 * (-0.5 * z * z).exp()
    })
}

pub fn waves() -> Field {
    smooth(
        "sines = { base = 0.8, amplitudes = [0.5, -0.2], frequencies = [1.3, 4.1], \
         phases = [0.4, 1.0] }",
        |t| 0.8 + 0.5 * (1.3 * t + 0.4).sin() - 0.2 * (4.1 * t + 1.0).sin(),
    )
}

/// Returns a second copy of a field, for lookups only.
pub fn twin(field: &Field) -> Field {
    let known = [homogeneous(), layers(), hills(), atmosphere(), blob(), waves()];
    let mut known = known.into_iter();
    known.find(|other| other.text == field.text).expect("a medium of this file")
}
