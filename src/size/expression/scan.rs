//! Looks at an expression token by token, so that every fault has a column.

use super::{ExpressionError, Variable};

/// A longer text is no gradation function but an attempt on the stack.
const LENGTH_MAX: usize = 4096;
/// Parentheses within parentheses.
const DEPTH_MAX: usize = 64;

const FUNCTIONS: [&str; 10] =
    ["abs", "sqrt", "exp", "log", "sin", "cos", "tan", "tanh", "atan", "floor"];
const FUNCTIONS_OF_TWO: [&str; 2] = ["min", "max"];
const CONSTANTS: [&str; 1] = ["pi"];

#[derive(Clone, Copy, Debug, PartialEq)]
enum Token<'a> {
    Number(&'a str),
    Name(&'a str),
    Sign(char),
}

/// A token and its column.
type Placed<'a> = (Token<'a>, usize);

/// An open parenthesis.
struct Open {
    column: usize,
    /// How many arguments it takes: 1 for a plain one.
    arguments: usize,
    commas: usize,
    is_call: bool,
    /// Whether a sign stands before it.
    signed: bool,
}

/// What may come next.
#[derive(Clone, Copy, PartialEq)]
enum State {
    /// An operand; whether a sign stands before it.
    Operand { signed: bool },
    /// The parenthesis of a function of so many arguments.
    Call { arguments: usize, signed: bool },
    /// An operator, after an operand that a sign stands before or not.
    Operator { signed: bool },
}

fn fault<T>(column: usize, problem: impl Into<String>) -> Result<T, ExpressionError> {
    Err(ExpressionError { column, problem: problem.into() })
}

/// Checks the text.
pub(super) fn check(text: &str) -> Result<(), ExpressionError> {
    if text.trim().is_empty() {
        return fault(1, "the expression is empty");
    }
    if text.len() > LENGTH_MAX {
        return fault(LENGTH_MAX, format!("an expression has at most {LENGTH_MAX} characters"));
    }
    let mut open: Vec<Open> = Vec::new();
    let mut state = State::Operand { signed: false };
    for (token, column) in tokens(text)? {
        state = match (state, token) {
            (State::Call { arguments, signed }, Token::Sign('(')) => {
                open.push(Open { column, arguments, commas: 0, is_call: true, signed });
                State::Operand { signed: false }
            }
            (State::Call { .. }, _) => return fault(column, "a function needs a `(`"),
            (State::Operand { signed }, token) => operand(token, column, signed, &mut open)?,
            (State::Operator { signed }, token) => operator(token, column, signed, &mut open)?,
        };
        if open.len() > DEPTH_MAX {
            return fault(column, format!("more than {DEPTH_MAX} parentheses within each other"));
        }
    }
    if !matches!(state, State::Operator { .. }) {
        return fault(text.chars().count() + 1, "the expression ends where an operand is missing");
    }
    match open.last() {
        Some(open) => fault(open.column, "this parenthesis is never closed"),
        None => Ok(()),
    }
}

fn operand(
    token: Token,
    column: usize,
    signed: bool,
    open: &mut Vec<Open>,
) -> Result<State, ExpressionError> {
    match token {
        Token::Number(text) => match text.parse::<f64>() {
            Ok(value) if value.is_finite() => Ok(State::Operator { signed }),
            _ => fault(column, format!("`{text}` is no finite number")),
        },
        Token::Name(name) => named(name, column, signed),
        Token::Sign('(') => {
            open.push(Open { column, arguments: 1, commas: 0, is_call: false, signed });
            Ok(State::Operand { signed: false })
        }
        Token::Sign('+' | '-') if !signed => Ok(State::Operand { signed: true }),
        Token::Sign(sign) => fault(column, format!("`{sign}` stands where an operand is missing")),
    }
}

fn named(name: &str, column: usize, signed: bool) -> Result<State, ExpressionError> {
    if FUNCTIONS.contains(&name) {
        return Ok(State::Call { arguments: 1, signed });
    }
    if FUNCTIONS_OF_TWO.contains(&name) {
        return Ok(State::Call { arguments: 2, signed });
    }
    let is_variable = Variable::ALL.iter().any(|v| v.name() == name);
    if is_variable || CONSTANTS.contains(&name) {
        return Ok(State::Operator { signed });
    }
    let variables: Vec<&str> = Variable::ALL.iter().map(|v| v.name()).collect();
    let problem = format!(
        "`{name}` is neither a variable ({}), nor pi, nor a function ({}, {})",
        variables.join(", "),
        FUNCTIONS.join(", "),
        FUNCTIONS_OF_TWO.join(", ")
    );
    fault(column, problem)
}

fn operator(
    token: Token,
    column: usize,
    signed: bool,
    open: &mut Vec<Open>,
) -> Result<State, ExpressionError> {
    let operand = Ok(State::Operand { signed: false });
    match token {
        // The evaluator would take (-x)^2, mathematics means -(x^2).
        Token::Sign('^') if signed => {
            fault(column, "a power after a sign reads two ways: write -(x^2) or (-x)^2")
        }
        Token::Sign('+' | '-' | '*' | '/' | '^') => operand,
        Token::Sign(',') => match open.last_mut() {
            Some(call) if call.is_call && call.commas + 1 < call.arguments => {
                call.commas += 1;
                operand
            }
            Some(call) if call.is_call => {
                let count = if call.arguments == 1 { "one argument" } else { "two arguments" };
                fault(column, format!("this function takes {count}"))
            }
            _ => fault(column, "a comma separates the arguments of min and max only"),
        },
        Token::Sign(')') => match open.pop() {
            None => fault(column, "this parenthesis was never opened"),
            Some(call) if call.commas + 1 < call.arguments => {
                fault(column, "this function takes two arguments")
            }
            Some(call) => Ok(State::Operator { signed: call.signed }),
        },
        _ => fault(column, "an operator is missing before this"),
    }
}

/// Splits the text; columns count characters from 1.
fn tokens(text: &str) -> Result<Vec<Placed<'_>>, ExpressionError> {
    let mut tokens = Vec::new();
    let mut rest = text;
    while let Some(first) = rest.chars().next() {
        let column = text[..text.len() - rest.len()].chars().count() + 1;
        let length = match first {
            c if c.is_ascii_whitespace() => {
                rest = &rest[1..];
                continue;
            }
            '0'..='9' | '.' => number_length(rest),
            c if c.is_ascii_alphabetic() => {
                rest.find(|c: char| !c.is_ascii_alphanumeric() && c != '_').unwrap_or(rest.len())
            }
            '+' | '-' | '*' | '/' | '^' | '(' | ')' | ',' => 1,
            other => return fault(column, format!("`{other}` has no meaning here")),
        };
        let (word, tail) = rest.split_at(length);
        tokens.push((
            match first {
                '0'..='9' | '.' => Token::Number(word),
                c if c.is_ascii_alphabetic() => Token::Name(word),
                sign => Token::Sign(sign),
            },
            column,
        ));
        rest = tail;
    }
    Ok(tokens)
}

/// The text with each number written without an exponent, which the evaluator does not read in all
/// forms; a float's shortest decimal reads back to the same bits.
pub(super) fn without_exponents(text: &str) -> Result<String, ExpressionError> {
    let mut plain = String::new();
    for (token, column) in tokens(text)? {
        match token {
            Token::Number(word) => match word.parse::<f64>() {
                Ok(value) => plain.push_str(&value.to_string()),
                Err(_) => return fault(column, format!("`{word}` is no number")),
            },
            Token::Name(name) => plain.push_str(name),
            Token::Sign(sign) => plain.push(sign),
        }
    }
    Ok(plain)
}

/// Length of the number at the start: digits, points, an exponent with its sign.
fn number_length(text: &str) -> usize {
    let mut before = ' ';
    for (i, c) in text.char_indices() {
        let in_exponent = matches!(c, '+' | '-') && matches!(before, 'e' | 'E');
        if !(c.is_ascii_digit() || matches!(c, '.' | 'e' | 'E') || in_exponent) {
            return i;
        }
        before = c;
    }
    text.len()
}

/// Column of the first token with this name.
pub(super) fn column_of(text: &str, name: &str) -> Option<usize> {
    let tokens = tokens(text).ok()?;
    tokens.into_iter().find(|(token, _)| *token == Token::Name(name)).map(|(_, column)| column)
}
